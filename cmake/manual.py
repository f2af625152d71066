#!/usr/bin/env python3
"""Writes the manual page and the completion of bash from the help of the program.

manual.py LULL FOLDER: runs `LULL --help` and `LULL COMMAND --help-all`, and writes FOLDER/lull.1 and
FOLDER/lull (for bash).
"""
import pathlib
import re
import subprocess
import sys

# What CLI11 adds to the name of a value: a check, choices, the default, and other options. (A word
# in small letters before :FILE is to be written, as in `--split paper:FILE`.)
VALUE = re.compile(r"^(?P<name>.*?(?:\|[A-Z]+=[A-Z]+)?)"
                   r"(?::(?P<check>(?:INT|UINT|FLOAT|POSITIVE|NONNEGATIVE)\b.*?|\{.*?\})"
                   r"|(?<=[A-Z.])(?P<file>[a-z0-9]*):FILE)?"
                   r"(?:=(?P<default>\S*))?(?P<repeated> \.\.\.)?$")
CHOICES = re.compile(r"([a-z0-9-]+(?:\|[a-z0-9-]+)+)(,\.\.\.)?")  # a value that is one of these words, or several
RULE = re.compile(r"  ([a-z]+)(\[?:\S+)?  ")  # how a stopping rule is written, where the help has them
RELATION = re.compile(r" (Needs|Excludes): (.*?)(?= Needs:| Excludes:|$)")
# How a long head goes on, where a text cannot begin.
GOES_ON = re.compile(r"Needs:|Excludes:|REQUIRED|in \[|\[|- |\d|\.\.\.")
TEXT = 30  # the column where texts begin


class Option:
    """One entry of a help text: its names, the name of its value and its description."""

    def __init__(self, head, text):
        names, _, rest = head.replace(" REQUIRED", "").partition(" ")
        self.names = re.sub(r"\{.*?\}", "", names).split(",")
        relations = RELATION.findall(" " + rest)
        value = VALUE.match(RELATION.sub("", " " + rest).strip())
        check = value["check"] or ""
        repeated = "" if value["name"].endswith(",...") else value["repeated"] or ""
        self.value = value["name"] + (value["file"] or "") + repeated
        words = CHOICES.fullmatch(self.value)
        self.choices = (check[1:-1].split(",") if check.startswith("{") else
                        words[1].split("|") if words else [])
        self.is_list = "," in self.value  # of choices, with commas
        self.text = text
        limits = re.search(r"\[(\S+) - (\S+)\]", check)
        if limits:
            self.text += f" ({limits[1]} to {limits[2]})"
        if value["default"]:
            self.text += f" [{value['default']}]"
        for relation, others in relations:
            verb = "needs" if relation == "Needs" else "not with"
            self.text += f" ({verb} {', '.join(others.split())})"


class Help:
    """A help text in parts: description, usage, entries and footer."""

    def __init__(self, text):
        head, _, rest = text.partition("\nUsage: ")
        self.about = " ".join(head.split())
        self.usage, _, rest = rest.partition("\n")
        self.entries, self.notes = {}, ""
        while True:
            section = re.match(r"\s*^(Positionals:\n|Subcommands:\n|[A-Z][\w ]+:\n(?=  -))", rest, re.M)
            if not section:
                break
            body, _, rest = rest[section.end():].partition("\n\n")
            self.entries[section[1][:-2]] = [Option(h, t) for h, t in entries(body)]
        self.notes = rest.strip("\n")

    def groups(self):
        """Returns the lists of options by title."""
        return {k: v for k, v in self.entries.items() if k not in ("Positionals", "Subcommands")}

    def options(self):
        return [option for group in self.groups().values() for option in group]


def entries(body):
    """Yields (head, text) of entries that begin with two blanks and go on with more."""
    found = []
    for line in body.split("\n"):
        if re.match(r"  \S", line):
            head, _, text = line.strip().partition("  ")
            if not text and line[TEXT - 1:TEXT] == " " and not GOES_ON.match(line[TEXT:]):
                head, text = line[:TEXT], line[TEXT:]
            head = head.strip()
            found.append([head, text.strip()])
        elif found:
            found[-1][1] = (found[-1][1] + " " + line.strip()).strip()
    return found


def help_of(lull, *command):
    return Help(subprocess.run([lull, *command, "--help-all" if command else "--help"], check=True, text=True,
                               stdout=subprocess.PIPE).stdout)


def roff(text):
    """Escapes the commands of troff."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in text.split("\n"))


def roff_options(options):
    lines = []
    for option in options:
        names = ", ".join("\\fB" + roff(n) + "\\fR" for n in option.names)
        value = " \\fI" + roff(option.value) + "\\fR" if option.value else ""
        lines += [".TP", names + value, roff(option.text) or "\\&"]
    return lines


def manual(version, main, commands):
    lines = [f'.TH LULL 1 "" "lull {version}" "User Commands"', ".SH NAME",
             "lull \\- path tracer that knows when to stop", ".SH SYNOPSIS",
             ".B lull", "\\fICOMMAND\\fR [\\fIOPTIONS\\fR]", ".SH DESCRIPTION", roff(main.about)]
    lines += roff_options(main.options())
    lines.append(".SH COMMANDS")
    for name, page in commands.items():
        lines += [f".SS {roff(page.usage)}", roff(page.about)]
        lines += roff_options(page.entries.get("Positionals", []))
        for title, options in page.groups().items():
            lines += [".PP", "\\fI" + roff(title) + "\\fR"] + roff_options(options)
        if page.notes:
            lines += [".PP", ".nf", roff(page.notes), ".fi"]
    lines += [".SH ENVIRONMENT", ".TP", "\\fBLULL_MODELS\\fR",
              "The folder of installed models, for programs that use the library (lull/lull.h).",
              ".SH EXIT STATUS", "0 success, 1 input or environment error, 2 usage error, "
              "130 interrupted."]
    return "\n".join(lines) + "\n"


def quoted(words):
    return "'" + " ".join(words) + "'"


def rules_of(page):
    """Returns the prefixes of stopping rules: with a colon where an argument has to follow."""
    section = page.notes.partition("(--stop)")[2].partition("\n\n")[0]
    rules = [RULE.match(line) for line in section.split("\n")]
    return [r[1] + (":" if (r[2] or "").startswith(":") else "") for r in rules if r]


def completion(main, commands):
    """Words are looked up by command; behind an option with choices these, else files. Where more
    may follow a word, no blank does."""
    def names(page):
        return [n for o in page.options() for n in o.names]

    rules = rules_of(commands["render"])
    lines = ["# Completion of bash for lull.", "_lull() {",
             "    local word=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]} words= command= given=",
             "    ((COMP_CWORD > 1)) && command=${COMP_WORDS[1]}",
             "    COMPREPLY=()",
             '    case "$command $last" in']
    for name, page in commands.items():
        for option in page.options():
            patterns = "|".join(f'"{name} {n}"' for n in option.names)
            if option.choices and option.is_list:
                lines.append(f"    {patterns}) words={quoted(option.choices)}")
                lines.append("        [[ $word == *,* ]] && given=${word%,*}, word=${word##*,}; _lull_goes_on ;;")
            elif option.choices:
                lines.append(f"    {patterns}) words={quoted(option.choices)} ;;")
            elif option.value.split(" ")[0] == "RULE":
                lines.append(f"    {patterns}) words={quoted(rules)}; _lull_goes_on ;;")
            elif option.value:
                lines.append(f"    {patterns}) return ;;")
    lines += ['    *) case "$command" in',
              f"        '') words={quoted(list(commands) + names(main))} ;;"]
    for name, page in commands.items():
        lines.append(f"        {name}) [[ $word == -* ]] && words={quoted(names(page))} ;;")
    lines += ["        esac ;;", "    esac",
              '    [[ -z $words ]] || COMPREPLY=($(compgen -P "$given" -W "$words" -- "$word"))', "}",
              "_lull_goes_on() { compopt -o nospace 2>/dev/null || :; }", "complete -o default -o bashdefault -F _lull lull"]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    lull, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    version = subprocess.run([lull, "--version"], check=True, text=True,
                             stdout=subprocess.PIPE).stdout.split()[-1]
    top = help_of(lull)
    commands = {o.names[0]: help_of(lull, o.names[0]) for o in top.entries["Subcommands"]}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "lull.1").write_text(manual(version, top, commands))
    (folder / "lull").write_text(completion(top, commands))


if __name__ == "__main__":
    main()
