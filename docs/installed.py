"""Writes what the programs print of themselves as files of an installed tree: schemas, man pages, completions.

installed.py BIN SHARE
"""

import pathlib
import re
import subprocess
import sys

PROGRAMS = ("lacuna", "lacuna-server")


def printed(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def subcommands(text):
    """(name, one line) of each."""
    part = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.MULTILINE)
    return re.findall(r"^  (\S+)\s+(.*)$", part.group(1), re.MULTILINE) if part else []


def options(text):
    return sorted(set(re.findall(r"^  (?:-\w,)?(--[a-z-]+)", text, re.MULTILINE)))


def roff(text):
    """A line as it stands."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def man_page(words, text, version):
    """--help, part by part: a heading for each of its own."""
    name = "-".join(words)
    about, rest = text.split("Usage:", 1)
    usage, rest = rest.split("\n", 1)
    lines = [f'.TH "{name.upper()}" 1 "" "{version}"', ".SH NAME",
             f"{roff(name)} \\- {roff(' '.join(about.split())).rstrip('.')}", ".SH SYNOPSIS", roff(usage.strip())]
    for block in re.split(r"\n\s*\n", rest.strip("\n")):
        first, *more = block.split("\n")
        title = re.fullmatch(r"([A-Z][A-Za-z ]+):", first)
        lines.append(f'.SH "{title.group(1).upper() if title else "NOTES"}"')
        lines += [".nf", *map(roff, more if title else [first, *more]), ".fi"]
    return "\n".join(lines) + "\n"


def completion(bin_folder):
    """Bash: the words that --help names, and files."""
    lines = []
    for program in PROGRAMS:
        function = "_" + program.replace("-", "_")
        text = printed(bin_folder / program, "--help")
        names = [name for name, _ in subcommands(text)]
        lines += [f"{function}() {{", '  local word=${COMP_WORDS[COMP_CWORD]} words', "  case ${COMP_WORDS[1]} in"]
        for name in names:
            lines.append(f"    {name}) words='{' '.join(options(printed(bin_folder / program, name, '--help')))}' ;;")
        lines += [f"    *) words='{' '.join(names + options(text))}' ;;", "  esac",
                  '  [ "$COMP_CWORD" -gt 1 ] || words=\'' + " ".join(names + options(text)) + "'",
                  '  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")', "}",
                  f"complete -o default -F {function} {program}"]
    return "\n".join(lines) + "\n"


def main():
    bin_folder, share = map(pathlib.Path, sys.argv[1:])

    def write(name, text):
        (share / name).parent.mkdir(parents=True, exist_ok=True)
        (share / name).write_text(text)

    write("lacuna/schema/job.schema.json", printed(bin_folder / "lacuna", "schema"))
    write("lacuna/schema/sweep.schema.json", printed(bin_folder / "lacuna", "schema", "--sweep"))
    write("lacuna/schema/figure.schema.json", printed(bin_folder / "lacuna", "schema", "--figure"))
    for program in PROGRAMS:
        text = printed(bin_folder / program, "--help")
        version = printed(bin_folder / program, "--version").strip()
        write(f"man/man1/{program}.1", man_page([program], text, version))
        for name, _ in subcommands(text):
            write(f"man/man1/{program}-{name}.1",
                  man_page([program, name], printed(bin_folder / program, name, "--help"), version))
    script = completion(bin_folder)
    for program in PROGRAMS:
        write(f"bash-completion/completions/{program}", script)


if __name__ == "__main__":
    main()
