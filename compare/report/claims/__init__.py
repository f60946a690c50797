from compare.report.claims.finding import Finding as Finding
from compare.report.claims.finding import Number as Number
from compare.report.claims.routes import RoutesDisagree as RoutesDisagree
from compare.report.claims.run import Claim as Claim
from compare.report.claims.run import Judged as Judged
from compare.report.claims.run import claims as claims
from compare.report.claims.run import judge as judge
