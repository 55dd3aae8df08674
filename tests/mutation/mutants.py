"""mutants: the small errors that a C++ source may have: what people mistype, one at a time.

Operators are found by the blanks around them, which clang-format puts there and not around those of templates; text in quotes,
comments, preprocessor lines and static assertions are left alone.
"""
import dataclasses
import re

SWAPS = {
    " < ": (" <= ", " >= "), " <= ": (" < ", " > "), " > ": (" >= ", " <= "), " >= ": (" > ", " < "),
    " == ": (" != ",), " != ": (" == ",), " && ": (" || ",), " || ": (" && ",),
    " + ": (" - ",), " - ": (" + ",), " * ": (" / ",), " / ": (" * ",), " % ": (" / ",),
    " += ": (" -= ",), " -= ": (" += ",), " << ": (" >> ",), " >> ": (" << ",), " & ": (" | ",), " | ": (" & ",), " ^ ": (" & ",),
}
WORDS = {"true": ("false",), "false": ("true",), "std::min": ("std::max",), "std::max": ("std::min",), "++": ("--",)}
NUMBER = re.compile(r"(?<![\w.'])(0x[0-9a-fA-F]+|\d+\.?\d*(?:e[+-]?\d+)?)(?![\w.'])")
CONDITION = re.compile(r"\bif \(")
STATEMENT = re.compile(r"^\s+(?!return|throw|case|break|continue|const |auto |using |static|if|for|while|switch|else|default|struct|enum|\})"
                       r"[\w:.>\-*\[\]]+(\(.*\)| [+\-|&^*/]?= .*|\+\+)?;$")
LEAVING = re.compile(r"^\s+(continue|break);$")


@dataclasses.dataclass(frozen=True)
class Mutant:
    at: int
    old: str
    new: str

    def applied_to(self, text):
        return text[:self.at] + self.new + text[self.at + len(self.old):]

    def described(self, text):
        begin = text.rfind("\n", 0, self.at) + 1
        line = text[begin:text.index("\n", self.at)].strip()
        column = self.at - begin
        return f"{line} | {self.old.strip() or self.old!r} -> {self.new.strip() or 'nothing'} at {column}"


def shielded(text):
    """The text with comments, strings, characters, preprocessor lines and static assertions blanked: same length, same lines."""
    pattern = re.compile(r'//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^#[^\n]*|static_assert[^\n]*', re.M)
    return pattern.sub(lambda m: "\x00" * len(m.group()), text)


def numbers(code):
    for m in NUMBER.finditer(code):
        word = m.group()
        value = float(int(word, 16)) if word.startswith("0x") else float(word)
        if "." in word or "e" in word and not word.startswith("0x"):
            yield Mutant(m.start(), word, repr(2 * value + (value == 0)))
        else:
            yield Mutant(m.start(), word, str(int(value) + 1))


def closing(code, at):
    """The place of the parenthesis that closes the one at `at`; None where there is none."""
    depth = 0
    for i in range(at, len(code)):
        depth += (code[i] == "(") - (code[i] == ")")
        if depth == 0:
            return i
    return None


def conditions(code, text):
    for m in CONDITION.finditer(code):
        end = closing(code, m.end() - 1)
        if end is None or ";" in code[m.end():end]:
            continue
        old = text[m.end():end]
        yield Mutant(m.end(), old, "false")
        yield Mutant(m.end(), old, f"!({old})")


def lines(code, text):
    at = 0
    for line, original in zip(code.split("\n"), text.split("\n")):
        if STATEMENT.match(original) or LEAVING.match(line):
            inner = original.strip()
            yield Mutant(at + original.index(inner), inner, ";")
        at += len(line) + 1


def mutants_of(text):
    """All of them, in the order of the text."""
    code = shielded(text)
    found = []
    for old, news in SWAPS.items():
        for m in re.finditer(re.escape(old), code):
            found += [Mutant(m.start(), old, new) for new in news]
    for old, news in WORDS.items():
        for m in re.finditer(re.escape(old) + (r"\b" if old[-1].isalpha() else ""), code):
            found += [Mutant(m.start(), old, new) for new in news]
    found += [*numbers(code), *conditions(code, text), *lines(code, text)]
    return sorted(set(found), key=lambda m: (m.at, m.new))
