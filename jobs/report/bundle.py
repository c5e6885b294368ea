"""Makes one script of an ES module and all that it imports, and a C++ source that holds it and the page's styles:

    bundle.py OUT.cpp WEB_FOLDER ENTRY STYLE...

Each module becomes a function that returns its exports, so that no two share a name. What this knows of the language is
what the page's modules use: named imports from "./FILE.js", and exported functions, classes and constants. What the
service makes itself (GIVEN) is not bundled: report_html.cpp puts it before the script."""

import pathlib
import re
import sys

IMPORT = re.compile(r'^import \{(?P<names>[^}]*)\} from "\./(?P<file>[^"]+)";\n', re.MULTILINE)
GIVEN = {"job_tables.js"}
EXPORT = re.compile(r"^export (?P<kind>async function|function|class|const|let) (?P<name>\w+)", re.MULTILINE)


def bundled(folder, entry, done):
    """The text of a module behind those that it needs; `done` has those that are there already."""
    if entry in done | GIVEN:
        return ""
    done.add(entry)
    text = (folder / entry).read_text(encoding="utf-8")
    before = "".join(bundled(folder, found["file"], done) for found in IMPORT.finditer(text))
    names = [found["name"] for found in EXPORT.finditer(text)]
    body = IMPORT.sub(lambda m: f"const {{{m['names'].replace(' as ', ': ')}}} = {variable(m['file'])};\n", text)
    body = EXPORT.sub(r"\g<kind> \g<name>", body)
    if left := re.search(r"^(import|export)\b.*", body, re.MULTILINE):
        sys.exit(f"{folder / entry}: cannot be bundled: {left[0]}")
    return f"{before}const {variable(entry)} = (() => {{\n{body}return {{ {', '.join(names)} }};\n}})();\n"


def variable(file):
    return "module_" + re.sub(r"\W", "_", file.removesuffix(".js"))


def literal(text):
    """A C++ raw string; in parts, because a compiler need not take long ones."""
    size = 8192
    return "\n".join(f'R"LACUNA({text[i:i + size]})LACUNA"' for i in range(0, len(text), size))


def main():
    out, folder = (pathlib.Path(a) for a in sys.argv[1:3])
    script = bundled(folder, sys.argv[3], set())
    style = "".join((folder / name).read_text(encoding="utf-8") for name in sys.argv[4:])
    if "</script" in script or "<!--" in script:
        sys.exit("the script would end its own element")
    out.write_text('#include "jobs/report/page_files.h"\n\nnamespace lacuna {\n'
                   f"const std::string_view report_style = {literal(style)};\n"
                   f"const std::string_view report_script = {literal(script)};\n}}  // namespace lacuna\n",
                   encoding="utf-8")


main()
