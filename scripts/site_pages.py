"""Hook for mkdocs.yml: adds the pages of the root folder to those of docs/, and adapts GitHub's Markdown."""

import pathlib
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parent.parent
OF_THE_ROOT = {"README.md": "index.md", "CONTRIBUTING.md": "CONTRIBUTING.md", "SECURITY.md": "SECURITY.md", "CHANGELOG.md": "CHANGELOG.md",
               "NOTICE.md": "NOTICE.md"}
ITEM, ROW = re.compile(r"(?:[-*]|\d+\.) "), re.compile(r"\|")


def on_files(files, config):
    for source, page in OF_THE_ROOT.items():
        text = re.sub(r"\]\(docs/", "](", (ROOT / source).read_text())
        files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown, **_):
    """Inserts the empty line that Python-Markdown needs before a list or a table, and GitHub does not."""
    lines, fenced, inside = [], False, False
    for line in re.sub(r"\]\(\.\./((?:\.\./)*)README\.md(#[\w-]+)?\)", r"](\1index.md\2)", markdown).splitlines():
        begins = bool(ITEM.match(line) or ROW.match(line))
        if begins and not fenced and not inside and lines and lines[-1].strip():
            lines.append("")
        fenced ^= line.startswith("```")
        inside = begins or (inside and line.startswith("  "))
        lines.append(line)
    return "\n".join(lines)
