"""Static friction is as stiff after something has broken as before."""

from __future__ import annotations

from tests.scenes import run

HELD = """:floor a :Floor . :table1 a :Table .
:block1 a :Block ; :on :table1 ; :mass 0.3 ; :length 0.04 ; :width 0.04 ; :height 0.04 .
:hand1 a :Gripper ; :pitch 90.0 ; :z 0.722 ; :opening 0.06 . :egg1 a :Egg ; :x 0.9 ; :z 1.6 .
"""


def test_an_egg_that_broke_does_not_loosen_what_a_hand_holds_elsewhere() -> None:
    log = run(HELD, "sequence([grasp(hand1, block1, 10), lift(hand1, 0.1), hold(hand1, 2.0)])")
    assert len(log.detachments.tick) > 0 and log.detachments.tick.max() < 1000
    below = log.poses[:, log.index("hand1/palm"), 2] - log.poses[:, log.index("block1"), 2]
    # Regularized friction lets it creep by 0.05 mm/s; a tenth as stiff, by ten times as much.
    assert abs(below[-500] - below[-1500]) < 1e-4
