from .api.building import build as build
from .api.campaigns import Campaign as Campaign
from .api.campaigns import read as read
from .api.comparisons import Comparison as Comparison
from .api.diagnoses import Diagnosis as Diagnosis
from .api.diagnoses import diagnose as diagnose
from .api.frames import save as save
from .api.linear import linearize as linearize
from .api.runs import simulate as simulate
from .api.samples import sample as sample
from .api.tyres import Tyre as Tyre
from .api.variants import Variant as Variant
from .errors import CampaignError as CampaignError
from .errors import Failure as Failure
from .errors import UsageError as UsageError
from .errors import WheelchairError as WheelchairError

__version__: str
