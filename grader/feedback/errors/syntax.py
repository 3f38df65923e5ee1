"""Syntax errors whose text does not say what is written otherwise in Python, by the line that they quote.

Source: the grammar of Python 3.11, and that of C++ and Python 2, from which the habits come.
"""

from __future__ import annotations

import re

from gz_course.grader.feedback.errors import explanation, table

BEFORE = ("imports",)

# Pattern of the quoted line -> what Python writes; asked in turn.
HABITS = table(r"""
\belse\s+if\b
    else if is one word in Python: elif CONDITION:
&&|\|\|
    Python writes and, or and not for &&, || and !
!(?!=)\s*\w
    Python writes not for !
\w(?:\+\+|--)\s*;?\s*$
    Python has no ++: x += 1 adds one
^(?:print|exec)\s+[^=(]
    print is a function: print(...)
^except\s+\w+\s*,\s*\w+\s*:
    the error gets its name by as: except Error as name:
^(?:if|elif|while)\b[^=]*[^=!<>:]=[^=]
    = assigns, == compares
\{\s*$|^\}
    a block is what is indented below a line that ends in a colon; it has no braces
^(?:class|def|if|for|while|import|from|in|is|not|and|or|lambda|global|pass|with|return)\s*=[^=]
    a word of the language cannot be the name of a variable
\bthen\s*:
    there is no then before the colon
^global\s+\w+\s*=
    global and the assignment are two lines
===
    == compares; === is no operator
<>
    != means unequal
^(?:import|from)\s+\w+/
    parts of a module's name are joined by a dot
^import\s+\S+\s+from\b
    the order is from MODULE import NAME
^from\s+[\w.]+\s+import\s+\w+\.\w
    what comes before the point belongs to the module: from PACKAGE.MODULE import NAME
^def\s+\w+\s+\w
    a name has no spaces: words are joined by _
^def\s+\w+\(.*['\"\d]
    a parameter is a name; its value is given by the call
^def\s+\w+\s*:
    brackets are missing after the name of the function
^(?:def|class|if|elif|else|for|while|try|except|finally|with)\b[^:]*$
    a colon is missing at the end of the line
^(?:const|let|var|auto|int|float|double|bool|string|String|void)\s+\w+\s*(?:=|\()
    Python declares no types before a name: x = 0.5, and def f(self): for a function
^new\s+\w|=\s*new\s+\w
    an object is made by calling its class, Twist(), without new
\?.*:
    the choice between two values is  A if CONDITION else B
^def\s+\w+\(.*\.\w+.*\)
    a parameter is a plain name, without self. before it
\d+[.,]?\d*\s*(?:m/s|rad/s|m|s|ms|cm|deg)\b
    numbers have no units in Python
->
    a field is reached by a dot, command.linear.x; -> is used in def only
//|/\*
    a comment begins with #
""")
WORDS = table(r"""
'\(' was never closed|'\[' was never closed|'\{' was never closed
    the bracket that is opened here is never closed: the missing one belongs in this line or the next
unterminated (?:f-)?string|EOL while scanning
    the quotes at the end of the text are missing
unmatched '[)\]}]'
    one closing bracket is too many here
cannot assign to function call
    the value goes on the right of =, the name that gets it on the left
positional argument follows keyword argument
    arguments with a name come last
'await' outside async function
    await is used only in a function that begins with async def
'return' outside function
    by its indentation this line belongs to no function
'self' .*|name '\w+' is (?:assigned|used|parameter) .*global
    global names variables of the file, and comes first in the function
f-string
    inside of the braces of an f-string stands an expression, with the other kind of quotes
""")


@explanation
def syntax(error: str, code: str) -> str:
    """Explain a SyntaxError; `error` ends in the line, as in `file.py, line 3: SyntaxError: invalid syntax: x++`."""
    match = re.search(r"SyntaxError: (.*)$", error, re.DOTALL)
    if match is None:
        return ""
    said, _, quoted = match[1].removeprefix("f-string: ").partition(": ")
    line = code or quoted
    if (
        "invalid" in match[1]
        or "expected" in match[1]
        or "'{' was never" in match[1]
        or "Missing parentheses" in match[1]
    ):
        bare = re.sub(r"(?P<q>['\"]).*?(?P=q)", "''", line.split("#")[0]).strip()
        for pattern, words in HABITS:
            if pattern.search(bare):
                return words
    for pattern, words in WORDS:
        if pattern.search(match[1] if "f-string" in match[1] else said):
            return words
    return ""
