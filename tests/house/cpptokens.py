"""Splits C++, C headers, protobuf schemas, JSON, JavaScript and CSS into tokens, for the checks in this folder.

tokens(text) yields (kind, text, line) for everything except white space. The kinds are:
  comment    from // to the end of the line, or /* … */
  string     a string literal with its prefix and quotes; in JavaScript also '…' and the pieces of a template
  char       a character literal; in JavaScript a regular expression
  number     with digit separators and suffix
  word       an identifier or keyword
  punct      an operator or bracket; ">>" is two of them
  directive  a preprocessor line with its continuation lines, without a // comment at its end

directive_tokens(text, line) splits a directive. body(literal) returns what is between the quotes. joined(tokens) drops the
comments and makes one string of adjacent ones.
"""
import re

PREFIX = r"(?:u8|[uUL])?"
STRING = r'"(?:\\.|[^"\\\n])*"'
CHAR = r"'(?:\\.|[^'\\\n])*'"
COMMENT = r"//(?:\\\n|[^\n])*|/\*.*?\*/"
TOKEN = rf"""
  (?P<comment>{COMMENT})
| (?P<string>{PREFIX}R"(?P<mark>[^()\\\s]{{0,16}})\(.*?\)(?P=mark)"|{PREFIX}{STRING})
| (?P<char>{PREFIX}{CHAR})
| (?P<number>\.?\d(?:[eEpP][+-]|'\w|[\w.])*)
| (?P<word>[^\W\d]\w*)
| (?P<punct>->\*?|\.\.\.|<=>|<<=?|\+\+|--|::|&&|\|\||[-+*/%&|^=!<>]=|\#\#|\S)
"""
DIRECTIVE = rf"""(?P<directive>^[ \t]*\#(?:\\\r?\n|{STRING}|{CHAR}|/\*.*?\*/|/(?!/)|[^\n/"'\\]|["'\\])*)"""
CPP = re.compile(f"{DIRECTIVE} | {TOKEN}", re.X | re.S | re.M)
IN_DIRECTIVE = re.compile(TOKEN, re.X | re.S)
JAVASCRIPT = re.compile(rf"""
  (?P<comment>{COMMENT}|\A\#![^\n]*)
| (?P<string>{STRING}|{CHAR})
| (?P<number>\.?\d(?:[eE][+-]|[\w.])*)
| (?P<word>\#?(?:[^\W\d]|\$)[\w$]*)
| (?P<punct>=>|\.\.\.|[=!]==?|\?\?=?|\?\.(?!\d)|&&=?|\|\|=?|\*\*=?|<<=?|\+\+|--|[-+*/%&|^<>]=|\S)
""", re.X | re.S)
TEMPLATE = re.compile(r"[`}](?:\\.|\$(?!\{)|[^`\\$])*(?:`|\$\{)", re.S)
REGEX = re.compile(r"/(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\[\n])+/[a-z]*")
BEFORE_REGEX = {"return", "typeof", "case", "in", "of", "do", "else", "throw", "void", "delete", "new", "await", "yield"}


def tokens(text, javascript=False):
    """Yields (kind, text, line) for each token of a source."""
    return javascript_tokens(text) if javascript else cpp_tokens(text)


def cpp_tokens(text, pattern=CPP, line=1):
    position = 0
    for match in pattern.finditer(text):
        kind, token, start = match.lastgroup, match.group(), match.start()
        if kind == "directive":
            start += len(token) - len(token.lstrip())
            token = token.strip()
        line += text.count("\n", position, start)
        position = start
        yield kind, token, line


def javascript_tokens(text):
    line, position, end = 1, 0, 0
    open_braces = []  # per open template: number of open braces in its current ${…}
    before = ("punct", "")
    while match := JAVASCRIPT.search(text, end):
        kind, token, start = match.lastgroup, match.group(), match.start()
        if token == "`" or (token == "}" and open_braces and open_braces[-1] == 0):
            piece = TEMPLATE.match(text, start)
            if piece:
                kind, token = "string", piece.group()
                if token[0] == "}":
                    open_braces.pop()
                if token[-1] == "{":
                    open_braces.append(0)
        elif open_braces and kind == "punct" and token in "{}":
            open_braces[-1] += 1 if token == "{" else -1
        elif token in ("/", "/="):
            is_value = before[0] in ("number", "string", "char") or before[1] in (")", "]", "}") or (
                before[0] == "word" and before[1] not in BEFORE_REGEX)
            regex = None if is_value else REGEX.match(text, start)
            if regex:
                kind, token = "char", regex.group()
        end = start + len(token)
        line += text.count("\n", position, start)
        position = start
        if kind != "comment":
            before = (kind, token)
        yield kind, token, line


def directive_tokens(text, line):
    """Yields the tokens of a preprocessor line. "#define NAME(" and a whole #include are each one token."""
    text = re.sub(r"\\(?=\r?\n)", " ", text)
    include = re.match(r'#\s*(include|import)\s*("[^"]*"|<[^>]*>)', text)
    if include:
        yield "directive", f"#{include[1]} {include[2]}", line
        return
    head = re.match(r"#\s*define\s+\w+\(?|#\s*\w*", text)
    yield "directive", re.sub(r"#\s+", "#", " ".join(head.group().split())), line
    yield from cpp_tokens(text[head.end():], IN_DIRECTIVE, line)
    yield "directive", "", line  # the end of the line is a token


def body(literal):
    """Returns the characters between the quotes of a literal; for a raw string, escaped as in an ordinary string."""
    raw = re.fullmatch(rf'{PREFIX}R"([^()\\\s]*)\((.*)\)\1"', literal, re.S)
    if raw:
        return raw[2].replace("\\", r"\\").replace('"', r"\"").replace("\n", r"\n")
    return re.sub(rf"^{PREFIX}[\"'`}}]|(?:[\"'`]|\$\{{)$", "", literal).replace("\\\n", "")


def joined(tokens_of_text):
    """Yields the tokens without comments, and adjacent string literals as one."""
    held = None
    for kind, token, line in tokens_of_text:
        if kind == "comment":
            continue
        if kind == "string" and held and token[0] not in "'`}":
            first, second = body(held[1]), body(token)
            # An escape with digits must not grow when its literal is joined with the next: "\x4" "1" is not "\x41".
            gap = '""' if re.search(r"\\(?:x[\da-fA-F]+|[0-7]{1,3})$", first) and re.match(r"[\da-fA-F]", second) else ""
            prefix = re.match(PREFIX, held[1]).group() or re.match(PREFIX, token).group()
            held = ("string", f'{prefix}"{first}{gap}{second}"', held[2])
            continue
        if held:
            yield held
            held = None
        if kind == "string" and token[0] not in "'`}":
            prefix = re.match(PREFIX, token).group()
            held = ("string", f'{prefix}"{body(token)}"', line)
        else:
            yield kind, token, line
    if held:
        yield held
