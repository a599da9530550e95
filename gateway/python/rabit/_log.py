"""The log of handlers and managers that are written in Python: the logger `rabit`."""

import logging
from types import TracebackType

logger = logging.getLogger("rabit")


def exception(text: str, kind: type[BaseException], value: BaseException, trace: TracebackType | None) -> None:
    logger.error(text, exc_info=(kind, value, trace))
