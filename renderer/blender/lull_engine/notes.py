"""What will look different, collected by its consequence."""
import contextlib
import traceback

from .process import Failure


class Notes:
    """Lists names by what happens to them, and sentences."""

    def __init__(self):
        self._names, self._sentences = {}, []

    def add(self, consequence, name, kind="objects"):
        """Notes that `name`, of a kind in the plural, will be so."""
        self._names.setdefault((kind, consequence), []).append(name)

    def say(self, sentence):
        if sentence not in self._sentences:
            self._sentences.append(sentence)

    @contextlib.contextmanager
    def of(self, name, kind="objects"):
        """Lets an exception end nothing but what concerns one thing."""
        try:
            yield
        except Failure:
            raise
        except Exception as e:  # whatever it is, the rest of the scene can be shown
            traceback.print_exc()
            self.add(f"left out or plain, after an error ({type(e).__name__}: {e})", name, kind)

    def lines(self):
        """Returns a line each, such as "2 materials are even: chalk, sand"."""
        lines = list(self._sentences)
        for (kind, consequence), names in self._names.items():
            names = sorted(set(names))
            shown = ", ".join(f"'{n}'" for n in names[:5]) + (" and others" if len(names) > 5 else "")
            is_one = len(names) == 1
            lines.append(f"{len(names)} {kind[:-1] if is_one else kind} {'is' if is_one else 'are'} {consequence}: {shown}")
        return lines

    def take(self, other):
        """Adds what other notes have."""
        for sentence in other._sentences:
            self.say(sentence)
        for key, names in other._names.items():
            self._names.setdefault(key, []).extend(names)
