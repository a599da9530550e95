"""YAML whose parts know their lines, and errors that name them."""

import difflib
import re

import yaml


class ScenarioError(Exception):
    """A mistake in a scenario: one line of text with the file and the line."""

    def __init__(self, where, text):
        super().__init__(f"{where}: {text}")


class Map(dict):
    """A mapping; `line_of` gives the line of a key."""

    def __init__(self):
        super().__init__()
        self.line = 0
        self.lines = {}

    def line_of(self, key):
        return self.lines.get(key, self.line)


class List(list):
    """A sequence; `lines` are those of its elements."""

    def __init__(self):
        super().__init__()
        self.line = 0
        self.lines = []


class Loader(yaml.SafeLoader):
    """Refuses a key that is used twice, and keeps lines."""


# `on`, `off`, `yes` and `no` stay words, as people write them in the rest of the project's files.
Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers
            if tag not in ("tag:yaml.org,2002:bool", "tag:yaml.org,2002:timestamp", "tag:yaml.org,2002:int")]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(true|false)$"), list("tf"))
Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?(0|[1-9][0-9]*)$"),
                             list("-+0123456789"))


def load(path):
    """The content of a file: Map, List, texts and numbers."""
    try:
        text = path.read_text()
    except OSError as error:
        raise ScenarioError(path, f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ScenarioError(path, "is no text in UTF-8") from error
    try:
        node = yaml.compose(text, Loader=Loader)
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise ScenarioError(f"{path}:{line}", f"is no YAML: {error.problem}") from error
    except yaml.YAMLError as error:
        raise ScenarioError(path, f"is no YAML: {error}") from error
    if node is None:
        raise ScenarioError(path, "is empty; `rabit lab new` writes a scenario")
    return _convert(path, node, 0)


def _convert(path, node, depth):
    line = node.start_mark.line + 1
    if depth > 20:
        raise ScenarioError(f"{path}:{line}", "is nested too deeply")
    if isinstance(node, yaml.MappingNode):
        result = Map()
        result.line = line
        for key_node, value_node in node.value:
            key = key_node.value if isinstance(key_node, yaml.ScalarNode) else None
            at = key_node.start_mark.line + 1
            if key is None or key in result:
                raise ScenarioError(f"{path}:{at}", "a key is a word" if key is None else f"`{key}` is there twice")
            result.lines[key] = at
            result[key] = _convert(path, value_node, depth + 1)
        return result
    if isinstance(node, yaml.SequenceNode):
        result = List()
        result.line = line
        for element in node.value:
            result.lines.append(element.start_mark.line + 1)
            result.append(_convert(path, element, depth + 1))
        return result
    try:
        return yaml.constructor.SafeConstructor().construct_object(node)
    except (yaml.YAMLError, ValueError) as error:
        raise ScenarioError(f"{path}:{line}", f"`{node.value}` cannot be read: {error}") from error


def nearest(word, known):
    """` did you mean ...`, or nothing."""
    found = difflib.get_close_matches(str(word), [str(k) for k in known], 1, 0.6)
    return f"; did you mean `{found[0]}`?" if found else ""


def plain(value):
    """Without lines: dict, list, texts and numbers, for JSON."""
    if isinstance(value, dict):
        return {key: plain(element) for key, element in value.items()}
    if isinstance(value, list):
        return [plain(element) for element in value]
    return value
