"""Converts keyword arguments into command-line arguments, by the help of the command."""
import difflib
import keyword
import os
import re

# An entry of a help text: its long names, and its value if it has one.
_ENTRY = re.compile(r"^  (?:-\w,)?--([a-z0-9-]+(?:,--[a-z0-9-]+)*)(?: (?!Needs:|Excludes:)(\S+))?")
_OURS = {"help", "help-all", "json-progress", "quiet"}  # set by this module


class Option:
    """An option of a command; `value` is its form in the help, None for a flag."""

    def __init__(self, name, value):
        self.name, self.value, self.text = name, value, ""

    def arguments(self, given):
        """Returns the command-line arguments for a Python value, or one of numpy."""
        given = given.tolist() if hasattr(given, "tolist") else given
        if given is None or given is False:
            return []
        flag = "--" + self.name
        if self.value is None or given is True:
            if self.value is not None or given is not True:
                raise TypeError("%s is %s" % (_keyword(self.name), "True or False" if
                                              self.value is None else self.value.split(":")[0]))
            return [flag]
        if not isinstance(given, (list, tuple)):
            return [flag, _text(given)]
        if "given again" in self.text:
            return [word for one in given for word in (flag, _text(one))]
        return [flag, ("x" if self.value.startswith("WxH") else ",").join(map(_text, given))]


def _keyword(name):
    word = name.replace("-", "_")
    return word + "_" if keyword.iskeyword(word) else word


def _text(value):
    return os.fsdecode(value) if isinstance(value, (os.PathLike, bytes)) else str(value)


def read(help_text):
    """Returns the options in the text of --help-all, by their keywords."""
    options, last = {}, None
    for line in help_text.split("\n"):
        if not line:  # the end of a group
            last = None
        if entry := _ENTRY.match(line):
            names = entry[1].split(",--")
            last = Option(names[0], entry[2])
            if last.name not in _OURS:
                options.update({_keyword(name): last for name in names})
        if last:
            last.text += line + "\n"
    return options


def arguments(command, options, given):
    """Returns command-line arguments for keywords.

    Raises: TypeError for unknown options and for values of a wrong type.
    """
    words = []
    for name, value in given.items():
        if name not in options:
            like = difflib.get_close_matches(name, options, 1)
            raise TypeError("%s() has no option %s%s" % (command, name, "; did you mean %s?" % like[0]
                                                         if like else ""))
        words += options[name].arguments(value)
    return words
