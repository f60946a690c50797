"""The report's conclusions, each with numbers by both routes and a verdict."""

from compare.report.claims.both_routes import RoutesDisagree
from compare.report.claims.finding import Finding, Number
from compare.report.claims.run import Claim, JudgedClaim, claims, judge

__all__ = ["Claim", "Finding", "JudgedClaim", "Number", "RoutesDisagree", "claims", "judge"]
