"""Splits all kinds of sources of this project into tokens, for the checks in this folder. Python, shell, CMake, HTML and files
with # comments are split here, the other languages by cpptokens.

language(path, text) names the language of a file. read(language, text) yields (kind, text, line) like cpptokens.tokens(),
with the kinds "string", "comment", "word", "punct", "directive" and:
  docstring  a statement of Python that is only a string
  heredoc    a here-document of a shell script, without its delimiters
  newline    the end of a line, where that ends a statement
  blank      white space between words of a shell command
  line       a piece of a line, outside quotes, in a language that is read by lines
"""
import ast
import io
import json
import re
import tokenize

from cpptokens import joined, tokens

CMAKE = re.compile(r"(?P<comment>#\[(=*)\[.*?\]\2\]|#[^\n]*)|(?P<string>\[(=*)\[.*?\]\4\]|\"(?:\\.|[^\"\\])*\")|"
                   r"(?P<punct>[()])|(?P<word>(?:\\.|[^\s()\"#\\])+)", re.S)
HTML = re.compile(r"(?P<comment><!--.*?-->)|(?P<tag></?[a-zA-Z!](?:\"[^\"]*\"|'[^']*'|[^\"'>])*>)|"
                  r"(?P<string>(?:[^<]|<(?![a-zA-Z/!]))+)", re.S)
ATTRIBUTE = re.compile(r"\"[^\"]*\"|'[^']*'|[^\s\"'=]+|=")
SHELL = re.compile(r"(?P<newline>\n)|(?P<blank>(?:[ \t\r]|\\\n)+)|(?P<here><<(-?)[ \t]*(['\"\\]?)([A-Za-z_]\w*)['\"]?)|"
                   r"(?P<quote>\$?['\"])|(?P<operator><<<|&&|\|\||;;|[;|&])|(?P<comment>#[^\n]*)|"
                   r"(?P<word>(?:\\.|[^\s'\"\\;|&<#$]|[<$#](?![<'\"]))+|.)", re.S)
SHELL_ESCAPES = re.compile(r"(?:\\.|[^'\\])*'?", re.S)
PAGES = (".md", ".svg", ".png")


def language(path, text):
    """Returns the name of a file's language: "page" for documentation and tables, "text" for a file without comments."""
    name = path.rsplit("/", 1)[-1]
    base = name[:-3] if name.endswith(".in") else name
    is_named = name in ("LICENSE", "changelog", "copyright") or re.match(r"docs/|tests/house/\w+\.txt", path)
    if is_named or name.endswith(PAGES) or re.search(r"\.\d$", base):
        return "page"
    first = text[:80].split("\n", 1)[0]
    for ends, found in (((".h", ".cpp", ".proto"), "cpp"), ((".js", ".mjs", ".css", ".json"), "javascript"), (".py", "python"),
                        ((".sh", ".bash", ".zsh"), "shell"), ((".cmake", "CMakeLists.txt"), "cmake"), (".html", "html"),
                        ((".yml", ".yaml", ".clang-tidy", ".clang-format"), "yaml")):
        if base.endswith(ends):
            return found
    if first.startswith("#!"):
        return "python" if "python" in first else "shell"
    if base.endswith(".txt") or "\0" in text:
        return "text"
    return "hash"


def read(kind, text):
    """Returns the tokens of a source."""
    if kind in ("cpp", "javascript"):
        return tokens(text, kind == "javascript")
    if kind == "python":
        try:
            return list(python_tokens(text))
        except (SyntaxError, tokenize.TokenError):  # a template of a Python file
            kind = "hash"
    others = {"shell": shell_tokens, "cmake": cmake_tokens, "html": html_tokens}
    return others[kind](text) if kind in others else line_tokens(text, kind)


def python_string(token):
    """Returns a string literal in a normal form, which does not depend on its kind of quotes."""
    prefix = re.match(r"\w*", token).group().lower()
    if "b" in prefix:
        return token
    if "f" in prefix:
        bare = token[len(prefix):]
        return 'f"' + (bare[3:-3] if bare[:3] in ('"""', "'''") else bare[1:-1]) + '"'
    return json.dumps(ast.literal_eval(token), ensure_ascii=False)


def python_tokens(text):
    skipped = (tokenize.COMMENT, tokenize.NL, tokenize.ENCODING, tokenize.ENDMARKER)
    if text.startswith("#!"):
        yield "word", text.split("\n", 1)[0], 1
    all_tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    found = [one for one in all_tokens if one.type not in skipped]
    yield from (("comment", one.string, one.start[0]) for one in all_tokens if one.type == tokenize.COMMENT)
    begins = True
    index = 0
    while index < len(found):
        one = found[index]
        index += 1
        if one.type == tokenize.STRING:
            strings = [python_string(one.string)]
            while index < len(found) and found[index].type == tokenize.STRING:
                strings.append(python_string(found[index].string))
                index += 1
            if len(strings) > 1 and all(string[0] in "f\"" for string in strings):
                is_f = any(string[0] == "f" for string in strings)
                plain = lambda string: string[1:-1].replace("{", "{{").replace("}", "}}") if is_f else string[1:-1]
                strings = ["f" * is_f + '"' + "".join(s[2:-1] if s[0] == "f" else plain(s) for s in strings) + '"']
            ends = index == len(found) or found[index].type == tokenize.NEWLINE
            yield "docstring" if begins and ends else "string", " ".join(strings), one.start[0]
            if begins and ends:
                index += 1
            continue
        begins = one.type in (tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT)
        if begins:
            yield "newline", tokenize.tok_name[one.type].lower(), one.start[0]
        else:
            yield "word" if one.type == tokenize.NAME else "punct", one.string, one.start[0]


def end_of_quote(text, at, closing):
    """Returns the end of the quoted text, $( ) or ${ } that begins before `at` and ends with `closing`."""
    is_double = closing in '"}'
    while at < len(text):
        char = text[at]
        at += 1
        if char == "\\" and closing != "'":
            at += 1
        elif char == closing:
            return at
        elif closing == "'":
            continue
        elif text[at - 1:at + 1] in ("$(", "${"):
            at = end_of_quote(text, at + 1, ")" if text[at] == "(" else "}")
        elif char == '"' or (char == "'" and not is_double):
            at = end_of_quote(text, at, char)
        elif char == "(" and closing == ")":
            at = end_of_quote(text, at, ")")
    return at


def shell_tokens(text):
    at, line, pending, blank, is_empty = 0, 1, [], False, True
    while match := SHELL.match(text, at):
        kind, token, end = match.lastgroup, match.group(), match.end()
        if kind == "comment" and not blank and not is_empty:
            kind, token, end = "word", "#", at + 1
        elif kind == "quote":
            kind = "string"
            end = SHELL_ESCAPES.match(text, end).end() if token == "$'" else end_of_quote(text, end, token[-1])
            token = text[at:end]
        elif kind == "here":
            kind = "word"
            pending.append(re.compile(rf"(.*?)^{match[4] and chr(9) + '*'}{match[6]}(?:\n|\Z)", re.S | re.M))
        if kind == "newline":
            if not is_empty:
                yield "newline", "\n", line
            blank, is_empty = False, True
            for here in pending:
                body = here.match(text, end)
                if body:
                    yield "heredoc", body[1], line + text.count("\n", at, end)
                    end = body.end()
            pending = []
        elif kind == "blank":
            blank = True
        elif kind == "comment" and (at or token[1:2] != "!"):
            yield "comment", token, line
        else:
            if blank and not is_empty:
                yield "blank", " ", line
            blank, is_empty = False, False
            yield {"operator": "punct", "comment": "word"}.get(kind, kind), token, line
        line += text.count("\n", at, end)
        at = end


def cmake_tokens(text):
    for match in CMAKE.finditer(text):
        yield match.lastgroup, match.group(), text.count("\n", 0, match.start()) + 1


def html_tokens(text):
    for match in HTML.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        if match.lastgroup == "tag":
            for part in ATTRIBUTE.findall(match.group()):
                yield "string" if part[0] in "\"'" else "word", part, line
        elif match.group().strip():
            yield match.lastgroup, " ".join(match.group().split()), line


def line_tokens(text, kind):
    for number, line in enumerate(text.split("\n"), 1):
        if kind != "text" and line.lstrip().startswith("#") and not line.startswith("#!"):
            yield "comment", line, number
            continue
        trailing = re.fullmatch(r"((?:\"(?:\\.|[^\"\\])*\"|'[^']*'|[^\"'])*?)\s+#\s.*", line)
        line = trailing[1] if trailing and kind == "yaml" else line.rstrip()
        if not line:
            continue
        described = re.fullmatch(r"(Description=|Comment=)(.+)", line)
        if described:
            yield "line", described[1], number
            line = f'"{described[2]}"'
        for part in re.findall(r"\"(?:\\.|[^\"\\])*\"|'[^']*'|[^\"']+|.", line):
            yield "string" if part[0] in "\"'" and len(part) > 1 else "line", part, number
        yield "newline", "\n", number
