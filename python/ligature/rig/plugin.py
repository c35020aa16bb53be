"""What pytest loads with the package: the option that selects the form of the rig, and the fixture ligature_rig."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from ligature.rig.forms import FORMS, form, use
from ligature.rig.rig import Rig


def pytest_addoption(parser: Any) -> None:
    group = parser.getgroup("ligature")
    group.addoption("--ligature-rig", choices=FORMS, default=FORMS[0],
                    help="what ligature.rig.Rig is: in virtual time (default), live on simulated devices, or a running rig in dry form")
    group.addoption("--ligature-bin", metavar="FOLDER", help="folder of the programs, for live; default: those of PATH")
    group.addoption("--ligature-firmware", metavar="OPTIONS", default="", help="further options of ligature-firmware run, for live")


def pytest_configure(config: Any) -> None:
    use(config.getoption("--ligature-rig"), config.getoption("--ligature-bin"), config.getoption("--ligature-firmware").split())


@pytest.fixture
def ligature_rig() -> Iterator[Callable[..., Rig]]:
    """Makes rigs that end with the test: ligature_rig(scene, faults=..) is a started Rig.

    On a real rig a test with faults is skipped, because nothing there can play them.
    """
    with ExitStack() as ends:
        def start(scene: Any, faults: Any = ()) -> Rig:
            if faults and form() == "real":
                pytest.skip("a real rig plays no fault scripts")
            return ends.enter_context(Rig(scene, faults))

        yield start
