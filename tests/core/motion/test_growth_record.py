"""What a project is told of a database that changed since it last saw it."""

from dataclasses import dataclass, field

from core.motion.growth_record import ADDED, NODES_DROPPED, REFITTED, REMOVED, ContentChange, changes_since, with_step


@dataclass
class Known:
    content_hash: str
    report: dict = field(default_factory=dict)


def grown(*steps):
    report = {"longest_gap_s": 0.1}
    for number, done in enumerate(steps):
        report = with_step(report, f"h{number}", f"h{number + 1}", done)
    return Known(f"h{len(steps)}", report)


def test_all_steps_since_are_summed_up():
    database = grown({ADDED: ["a", "b"]}, {REMOVED: ["x"]}, {ADDED: ["c"], REFITTED: ()}, {NODES_DROPPED: ["b:3"]})
    assert changes_since(database, "h0") == ContentChange(("a", "b", "c"), ("x",), ("b:3",), True)
    assert changes_since(database, "h3") == ContentChange(nodes_dropped=("b:3",))
    assert changes_since(database, "h4") == ContentChange()
    assert database.report["longest_gap_s"] == 0.1


def test_what_came_and_went_is_not_told_and_what_went_and_came_is_told_twice():
    assert changes_since(grown({ADDED: ["a"]}, {REMOVED: ["a"]}), "h0") == ContentChange()
    assert changes_since(grown({REMOVED: ["a"]}, {ADDED: ["a"]}), "h0") == ContentChange(("a",), ("a",))


def test_an_unknown_content_and_a_made_up_record_are_no_answer():
    assert changes_since(grown({ADDED: ["a"]}), "other") is None
    for nonsense in (7, "growth", [1, None], [{"before": 3}], {"before": "h0"}):
        assert changes_since(Known("h1", {"growth": nonsense}), "h0") is None
    odd = [{"before": "h0", "added": [1, {}, "a"], "removed": 9}]
    assert changes_since(Known("h1", {"growth": odd}), "h0") == ContentChange(added=("a",))
