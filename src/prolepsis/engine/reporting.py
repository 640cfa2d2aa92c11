"""What controllers may report: only what some kind of the scene has declared."""

from __future__ import annotations

from prolepsis.engine.channels import known_channels
from prolepsis.log.happenings import Happening
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import InputError, UnknownNameError, brief_list


def check_attribute(scene: Scene, name: str, attribute: str) -> None:
    """Check that a thing has an attribute that is set.

    Raises:
        UnknownNameError: If there is no such thing, or no kind declares a channel of that name that is set.
        InputError: If the channel is not of such things.
    """
    thing, where = scene.thing(name), f"an attribute set of {name}"
    channels = {each.name: each for each in known_channels(scene.kinds).values() if each.read is None}
    if attribute not in channels:
        raise UnknownNameError.of("channel that is set", attribute, channels, where)
    role = channels[attribute].role
    if role is not None and role not in thing.roles:
        raise InputError(f"{where}: {attribute} is of a {role}, which it is not")


def check_happening(scene: Scene, happening: Happening) -> None:
    """Check that a kind declares what is reported.

    Raises:
        UnknownNameError: If no kind declares that type.
        InputError: If it has other arguments or numbers, or an argument is no thing.
    """
    known = {each.name: each for kind in scene.kinds for each in kind.happenings}
    if happening.type not in known:
        raise UnknownNameError.of("type of happenings", happening.type, known)
    declared = known[happening.type]
    for given, needed in ((happening.things, declared.things), (happening.numbers, declared.numbers)):
        if {*given} != {*needed}:
            raise InputError(f"{happening.type}: reported with {brief_list(given)}; declared: {brief_list(needed)}")
    count = len(scene.things)
    for argument, index in happening.things.items():
        if not 0 <= index < count:
            raise InputError(f"{happening.type}: {argument} is {index}, which is no index of the {count} things")
