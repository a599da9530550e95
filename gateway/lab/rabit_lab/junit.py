"""The verdicts as JUnit XML, for continuous integration."""

from xml.etree import ElementTree


def write(scenario, verdicts, flight, interrupted, path):
    """One test case for each expectation."""
    suite = ElementTree.Element("testsuite", name=scenario.path.stem, tests=str(len(verdicts)), time=f"{flight.end:.3f}",
                                failures=str(sum(not verdict.good for verdict in verdicts)),
                                errors="1" if interrupted else "0")
    for verdict in verdicts:
        case = ElementTree.SubElement(suite, "testcase", classname=f"lab.{scenario.path.stem}", name=clean(verdict.text),
                                      file=str(scenario.path), line=str(verdict.line))
        if not verdict.good:
            failure = ElementTree.SubElement(case, "failure", message=clean(verdict.detail))
            failure.text = clean(f"{scenario.path}:{verdict.line}: {verdict.text}: {verdict.detail}")
    if interrupted:
        case = ElementTree.SubElement(suite, "testcase", classname=f"lab.{scenario.path.stem}", name="the run")
        ElementTree.SubElement(case, "error", message="interrupted")
    for note in flight.notes:
        suite.append(ElementTree.Comment(clean(note).replace("--", "- ")))
    ElementTree.indent(suite)
    ElementTree.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


def clean(text):
    """Without the characters that XML does not allow."""
    return "".join(c if c in "\t\n" or ord(c) >= 0x20 and not 0xD800 <= ord(c) <= 0xDFFF and ord(c) < 0xFFFE else "?"
                   for c in str(text))
