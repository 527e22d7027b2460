"""Speed against accuracy: the ladder of models and tolerances, measured for a scene."""

from rockframe.ladder.models import model_ladder as model_ladder
from rockframe.ladder.recommend import Recommendation as Recommendation
from rockframe.ladder.recommend import recommend as recommend
from rockframe.ladder.tradeoff import tradeoff as tradeoff
