"""``prolepsis list`` and ``prolepsis describe``: what there is, and what is known of it."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from prolepsis.commands.kept import is_as_installed, kept
from prolepsis.commands.output import add_command, table
from prolepsis.terms.errors import UnknownNameError

if TYPE_CHECKING:
    from prolepsis.knowledge import KnowledgeBase
    from prolepsis.knowledge.vocabulary import ClassEntry, Property
    from prolepsis.log.fact_types import FactType
    from prolepsis.programs import ActionSpec
    from prolepsis.programs.action import ParameterSpec
    from prolepsis.scene.kind import Channel

LIST_EXAMPLE = """\
  prolepsis list actions
  prolepsis list
"""
DESCRIBE_EXAMPLE = """\
  prolepsis describe EggShell
  prolepsis describe grasp
  prolepsis describe supports
  prolepsis describe friction
"""

Rows = Iterable[Sequence[str]]


def add_to(commands: Any) -> None:
    """Add both commands and their arguments."""
    parser = add_command(commands, "list", "list what there is, a line each", LIST_EXAMPLE, run_list)
    parser.add_argument("what", nargs="?", choices=list(SECTIONS), help="what to list; everything if not given")
    parser = add_command(
        commands,
        "describe",
        "describe what has a name in `prolepsis list`, or a property",
        DESCRIBE_EXAMPLE,
        run_describe,
    )
    parser.add_argument("name", metavar="NAME", help="as `prolepsis list` shows it, or the name of a property")


def run_list(given: argparse.Namespace) -> int:
    """Print one section, or all of them with headings."""
    if given.what:
        print(table(_rows(given.what, is_as_installed())))
        return 0
    as_installed = is_as_installed()
    for number, section in enumerate(SECTIONS):
        print(("\n" if number else "") + f"{section}:")
        print(table(_rows(section, as_installed), indent="  "))
    return 0


def _rows(section: str, as_installed: bool) -> Rows:
    rows = SECTIONS[section]
    # Examples lie outside the package.
    return rows() if rows is _examples or not as_installed else kept(section, lambda: [list(row) for row in rows()])


def run_describe(given: argparse.Namespace) -> int:
    """Print what is known of a name."""
    name: str = given.name
    print(kept(f"describe {name}", lambda: describe(name)) if is_as_installed() else describe(name))
    return 0


def describe(name: str) -> str:
    """Return what is known of a name; a name may stand for several, such as the fluent and the property ``broken``.

    Raises:
        UnknownNameError: If nothing is called so.
    """
    from prolepsis.programs import ACTIONS
    from prolepsis.programs.conditions import CONDITIONS

    knowledge, facts, channels = _knowledge(), _facts(), _known_channels()
    vocabulary = knowledge.vocabulary
    fact = facts.get(name[:1].lower() + name[1:])
    found = [_class(vocabulary.classes[name], knowledge)] if name in vocabulary.classes else []
    found += [_action(ACTIONS[name])] if name in ACTIONS else []
    found += [_condition(name)] if name in CONDITIONS else []
    found += [f"{_usage(fact)}: {fact.kind}\n  {fact.doc}"] if fact is not None else []
    found += [_channel(channels[name])] if name in channels else []
    found += [_property(vocabulary.properties[name], knowledge)] if name in vocabulary.properties else []
    found += [_individual(name, knowledge)] if name in knowledge.individuals else []
    if not found:
        known = {*vocabulary.classes, *ACTIONS, *CONDITIONS, *facts, *channels}
        known |= {*vocabulary.properties, *knowledge.individuals}
        what = "class, property, individual, action, condition, fluent, event or channel"
        raise UnknownNameError.of(what, name, known)
    return "\n\n".join(found)


def examples_folder() -> Path:
    """Return where the example scenarios are: in the installed package, or beside the source tree."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "examples"
    return installed if installed.is_dir() else package.parent.parent / "examples"


def _objects() -> Rows:
    knowledge = _knowledge()
    for name, entry in knowledge.vocabulary.classes.items():
        if "PhysicalObject" in knowledge.vocabulary.told_classes((name,)):
            yield name, _first_line(entry.comment)


def _actions() -> Rows:
    from prolepsis.programs import ACTIONS

    return ((spec.usage(), _first_line(spec.doc)) for _, spec in sorted(ACTIONS.items()))


def _conditions() -> Rows:
    from prolepsis.programs.conditions import CONDITIONS

    return [
        *((spec.usage(name), spec.doc) for name, spec in sorted(CONDITIONS.items())),
        ("not(Condition)", "The condition does not hold."),
    ]


def _fluents() -> Rows:
    return ((_usage(fact), _first_line(fact.doc)) for fact in _facts().values() if fact.kind == "fluent")


def _events() -> Rows:
    return ((_usage(fact), _first_line(fact.doc)) for fact in _facts().values() if fact.kind == "event")


def _channels() -> Rows:
    return ((each.name, each.role or "all", _logged(each), each.doc) for _, each in sorted(_known_channels().items()))


def _examples() -> Rows:
    for file in sorted(examples_folder().glob("*.toml")):
        first = file.read_text(encoding="utf-8").splitlines()[:1]
        yield str(file), first[0].lstrip("# ") if first and first[0].startswith("#") else ""


SECTIONS: Mapping[str, Callable[[], Rows]] = {
    "objects": _objects,
    "actions": _actions,
    "conditions": _conditions,
    "fluents": _fluents,
    "events": _events,
    "channels": _channels,
    "examples": _examples,
}


def _knowledge() -> KnowledgeBase:
    from prolepsis.knowledge import KnowledgeBase

    return KnowledgeBase.load()


def _facts() -> Mapping[str, FactType]:
    from prolepsis.fluents import fact_types

    import_module("prolepsis.programs")  # which declares the events of actions
    return fact_types()


def _known_channels() -> Mapping[str, Channel]:
    from prolepsis.engine.channels import known_channels
    from prolepsis.matter.kinds import known_kinds

    return known_channels(known_kinds())


def _logged(channel: Channel) -> str:
    """Return when a channel is logged of what has it."""
    if channel.needed:
        return "always"
    return "by default" if channel.default else "if chosen"


def _channel(channel: Channel) -> str:
    role = channel.role or "thing"
    return f"{channel.name}: channel of each {role}, logged {_logged(channel)}\n  {channel.doc}"


def _usage(fact: FactType) -> str:
    return f"{fact.name}({', '.join(fact.arguments)})" if fact.arguments else fact.name


def _action(spec: ActionSpec) -> str:
    return f"{spec.usage()}: action\n  {spec.doc}\n" + _parameters(spec.parameters)


def _condition(name: str) -> str:
    from prolepsis.programs.conditions import CONDITIONS

    spec = CONDITIONS[name]
    return f"{spec.usage(name)}: condition\n  {spec.doc}\n" + _parameters(spec.parameters)


def _parameters(parameters: Iterable[ParameterSpec]) -> str:
    from prolepsis.programs.action import KINDS

    return table(((parameter.name, KINDS[parameter.kind]) for parameter in parameters), indent="  ")


def _individual(name: str, knowledge: KnowledgeBase) -> str:
    rows = [
        (prop, f"{known.value:.6g}" if isinstance(known.value, float) else str(known.value), known.unit, known.origin)
        for prop, known in knowledge.quantities(name).items()
    ]
    return f"{name}: individual of {', '.join(knowledge.classes(name))}\n" + table(rows, indent="  ")


def _class(entry: ClassEntry, knowledge: KnowledgeBase) -> str:
    vocabulary = knowledge.vocabulary
    lines = [f"{entry.name}: {'defined class, inferred by the reasoner' if entry.defined else 'class'}"]
    lines += [f"  {entry.comment}"] if entry.comment else []
    above = [name for name in vocabulary.told_classes((entry.name,)) if name != entry.name]
    below = [name for name, other in vocabulary.classes.items() if entry.name in other.parents]
    for title, names in (("parents", entry.parents), ("all superclasses", above), ("subclasses", below)):
        lines += [f"  {title}: {', '.join(names)}"] if names else []
    lines += [f"  corresponds to: {', '.join(entry.alignments)}"] if entry.alignments else []
    lines += [
        f"  default part: {part.kind}{f', {part.counted_by} of them' if part.counted_by else ''} "
        f"({part.certainty}: {part.source})"
        for part in entry.parts
    ]
    lines += [
        f"  limit: {limit.name} {limit.bounds}"
        for name in (entry.name, *above)
        for limit in vocabulary.classes[name].limits
    ]
    rows = [("default", "value", "sd", "unit", "from", "how known")]
    for name in sorted(vocabulary.properties):
        found = knowledge.default_of((entry.name, *above), name)
        if found is not None:
            owner, default = found
            value = f"{default.value:.6g}" if isinstance(default.value, float) else str(default.value)
            deviation = f"{default.deviation:.3g}" if default.deviation else ""
            how = f"{default.certainty}: {default.source}"
            rows.append((name, value, deviation, vocabulary.properties[name].si_unit, owner, how))
    return "\n".join(lines) + ("\n" + table(rows, indent="  ") if len(rows) > 1 else "")


def _property(entry: Property, knowledge: KnowledgeBase) -> str:
    unit = f" [{entry.unit}]" if entry.unit else ""
    lines = [f"{entry.name}{unit}: property ({entry.kind})"]
    lines += [f"  {entry.comment}"] if entry.comment else []
    lines += [f"  allowed: {entry.bounds}"] if entry.bounds else []
    lines += [f"  parents: {', '.join(entry.parents)}"] if entry.parents else []
    owners = [
        name
        for name, other in knowledge.vocabulary.classes.items()
        if any(default.property == entry.name for default in other.defaults)
    ]
    lines += [f"  classes with a default: {', '.join(owners)}"] if owners else []
    return "\n".join(lines)


def _first_line(text: str) -> str:
    return text.strip().split("\n")[0]
