from compare.claims.finding import Finding as Finding
from compare.claims.finding import Number as Number
from compare.claims.routes import RoutesDisagree as RoutesDisagree
from compare.claims.run import Claim as Claim
from compare.claims.run import Judged as Judged
from compare.claims.run import claims as claims
from compare.claims.run import judge as judge
