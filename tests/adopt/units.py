"""Tests of the modules of dragonfly-adopt, one class each. They need no compiler and no sandbox."""
import os
import tempfile
import time
import types
import unittest
import unittest.mock

import fixtures
from adopt import files as filenames
from adopt import (blame, bounded, compiler, engine, folder, game, includes, keys, microsoft, naiad, programs, project, report, running, text,
                   treatments, trial, verdicts)
from support import MODULES, WORK, made, run_as_user, within

# A script that lowers its limits and then calls sandbox.limits(), which must not raise them. It prints the limits.
LIMITED = """
import resource, sys
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
from adopt import sandbox
resource.setrlimit(resource.RLIMIT_NOFILE, (100, 100))
resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
sandbox.limits(60)
print(resource.getrlimit(resource.RLIMIT_NOFILE), resource.getrlimit(resource.RLIMIT_AS)[1] >> 20, resource.getrlimit(resource.RLIMIT_CPU))
"""


class ListsTest(unittest.TestCase):
    """Tests how project files are read."""

    def lists(self, files):
        place = made(files)
        names = sorted(files)
        return project.read_lists(place, names, [name for name in names if folder.is_source(name)])

    def test_ProjectFilesOfManyKinds(self):
        for name, body in (("Makefile", "SRC = src\nGAMESRC = $(SRC)/A.cpp \\\n $(SRC)/b.cpp # C.cpp\nclean:\n\trm src/C.cpp\n"),
                           ("Makefile", "OBJ = src/A.o src/B.o\ngame: $(OBJ)\n\tg++ $(OBJ)\n.cpp.o:\n\tg++ -c $<\n"),
                           ("CMakeLists.txt", "set(S src)\nadd_executable(g ${S}/A.cpp\n ${S}/B.cpp)\n"),
                           ("g.vcxproj", '<ClCompile Include="src\\A.cpp" />\n<ClCompile Include="src\\b.CPP"><X/></ClCompile>\n'
                                         '<ClInclude Include="src\\C.h"/>'),
                           ("vs/g.vcxproj", '<ClCompile Include="..\\src\\A.cpp" />\r\n<ClCompile Include="..\\src\\B.cpp" />'),
                           ("vs/g.vcxproj", '<ClCompile Include="..\\..\\..\\x64\\A.cpp" />\r\n<ClCompile Include="..\\src\\B.cpp" />'),
                           ("g.cbp", '<Unit filename="src/A.cpp" />\n<Unit filename="src/B.cpp" />'),
                           ("g.xcodeproj/project.pbxproj", "/* A.cpp in Sources */ = {};\n/* B.cpp in Sources */ = {};")):
            found = self.lists({name: body, "src/A.cpp": "", "src/B.cpp": "", "src/C.cpp": ""})
            self.assertEqual([sorted(one.sources) for one in found], [["src/A.cpp", "src/B.cpp"]], (name, body))

    def test_WhatVisualStudioExcludesIsNotListed(self):
        for name, body in (("g.vcxproj", '<ClCompile Include="A.cpp">\n<Optimization>Disabled</Optimization></ClCompile><ClCompile Include="Old.cpp">\n'
                                         "<ExcludedFromBuild Condition=\"'$(Configuration)'=='Debug'\">true</ExcludedFromBuild></ClCompile>"
                                         '<ClCompile Include="B.cpp" /><None Include="x"><ExcludedFromBuild>true</ExcludedFromBuild></None>'),
                           ("g.vcproj", '<File\n RelativePath=".\\A.cpp"\n>\n</File><File RelativePath=".\\Old.cpp"><FileConfiguration Name="Debug|Win32"'
                                        ' ExcludedFromBuild="true"></FileConfiguration></File><File RelativePath=".\\B.cpp"></File>')):
            found = self.lists({name: body, "A.cpp": "", "B.cpp": "", "Old.cpp": ""})
            self.assertEqual([one.sources for one in found], [["A.cpp", "B.cpp"]], name)

    def test_AListOfNamesIsPreferredToAPattern(self):
        code = {"game.cpp": "int main() { GM.run(); }", "Hero.cpp": "", "Old.cpp": "", "Older.cpp": ""}
        files = {**code, "Makefile": "game: *.cpp\n", "CMakeLists.txt": "add_executable(g game.cpp Hero.cpp Gone.cpp Lost.cpp Moved.cpp)",
                 "g.vcxproj": '<ClCompile Include="game.cpp" /><ClCompile Include="Hero.cpp" />'}
        found = programs.programs(sorted(code), self.lists(files), code.get)
        self.assertEqual((found[0].source_list.file, found[0].sources), ("g.vcxproj", ["game.cpp", "Hero.cpp"]))

    def test_DefinitionsAreThoseForThisSystem(self):
        body = "CC = g++ -DLINUX -D ROCKS=5 -DWIN32 -D__APPLE__ -DOSX=1 -DWINDOW=80 # -DOLD\n" \
               "X = \"-DQUOTED\" -DTEXT=\\\"a\\\" x-DNO -D1 $(CC) -DLINUX\ngame: A.cpp\n"
        self.assertEqual(self.lists({"Makefile": body, "A.cpp": ""})[0].definitions, ["-DLINUX", "-DROCKS=5", "-DWINDOW=80", "-DQUOTED"])

    def test_PatternsAndWhatIsNotThere(self):
        found = self.lists({"Makefile": "SRC = $(wildcard src/*.cpp) Gone.cpp ../../etc/passwd.cpp\n", "src/A.cpp": "", "src/B.cpp": "", "C.cpp": ""})[0]
        self.assertEqual(sorted(found.sources), ["src/A.cpp", "src/B.cpp"])
        self.assertEqual(found.missing, ["Gone.cpp", "../../etc/passwd.cpp"])
        for call, deep in (("GLOB", False), ("GLOB_RECURSE", True)):
            found = self.lists({"CMakeLists.txt": f"file({call} S src/*.cpp)\n", "src/A.cpp": "", "src/deep/B.cpp": ""})[0]
            self.assertEqual("src/deep/B.cpp" in found.sources, deep)

    def test_NoListTakesLongToRead(self):
        for name, body in (("Makefile", "a" * 900_000), ("Makefile", "a/" * 450_000), ("Makefile", "a/b.o-" * 150_000), ("Makefile", "\n" * 900_000),
                           ("Makefile", "x.cpp " * 150_000), ("CMakeLists.txt", "\\\n" * 300_000), ("g.vcxproj", "<File " * 150_000),
                           ("g.cbp", "<Unit " * 150_000), ("Makefile", "*a" * 100 + ".cpp"),
                           ("CMakeLists.txt", "file(GLOB_RECURSE s " + "*a" * 100 + ".cpp)")):
            with within(self, 3, (name, body[:20])):
                self.lists({name: body, **{f"{'a' * 200}{number}.cc": "" for number in range(20)}})

    def test_ManyChangesOfOneFileTakeOneWrite(self):
        place = made({"Hero.h": "", "a.cpp": '#include "hero.h"\n' * 40_000})
        sources = text.Sources(place, ["Hero.h", "a.cpp"])
        with within(self, 3, "includes"):
            self.assertEqual(len(includes.Includes(sources, [""], types.SimpleNamespace(headers=[]), []).treat()), 40_000)
            sources.flush()
        with open(os.path.join(place, "a.cpp"), encoding="ascii") as file:
            self.assertEqual(file.readline(), '#include "Hero.h"\n')

    def test_TheGameIsChosenBeforeTheTutorialBesideIt(self):
        code = {"saucer-shoot/game.cpp": "int main() { GM.run(); }", "saucer-shoot/Hero.cpp": "", "game.cpp": "int main(int c, char **v) { GM.run(); }",
                "Hero.cpp": "", "test.cpp": "int main() {}", "Other.cpp": "int mainly(); // int main()"}
        found = programs.programs(sorted(code), [], lambda name: text.code_only(code[name]))
        self.assertEqual([one.main for one in found], ["game.cpp", "saucer-shoot/game.cpp", "test.cpp"])
        self.assertEqual(found[0].sources, ["game.cpp", "Hero.cpp", "Other.cpp"])


class EngineTest(unittest.TestCase):
    """Tests which files count as a copy of the engine: those that define one of its names in namespace df. The name of the file
    is not enough."""

    def engine_files(self, files):
        place = made(files)
        names = naiad._published(os.path.join(MODULES, "adopt", "published-names.txt"))
        return engine.EngineCopies(place, sorted(files), names).files

    def test_FilesOfTheGameAreKeptWhateverTheirNames(self):
        for name, body in (("Player.h", "using namespace df;\nclass Player : public Object {};"), ("World.h", "namespace df { class World {}; }"),
                           ("Path.h", "namespace df { class Path; }\nclass Path {};"), ("Grid.h", "namespace df { class Object; }\nclass Grid {};"),
                           ("State.h", "using namespace df;\nenum State { A };"), ("utility.h", "using namespace df;\nint sum();")):
            self.assertEqual(self.engine_files({name: body}), [], name)

    def test_CopiesOfTheEngineAreLeftOut(self):
        for name, body in (("Object.h", "namespace df {\nclass Object : public Thing {\n};\n}"),
                           ("object.h", "namespace df\n{\nstruct A {};\nclass Object {};\n}"),
                           ("Color.h", "namespace df { enum Color { RED }; }"), ("utility.h", "namespace df { int sum(); }"),
                           ("Solidness.h", "namespace df { enum class Solidness { HARD }; }")):
            self.assertEqual(self.engine_files({name: body}), [name])

    def test_LinksBetweenGameAndEngineAreDropped(self):
        place = tempfile.mkdtemp(dir=WORK)
        fixtures.write(place + "/game", {"dragonfly/Object.h": fixtures.engine_header("Object"), "Base.h": fixtures.engine_header("Event")})
        os.symlink("dragonfly/Object.h", place + "/game/Thing.h")
        os.symlink("Base.h", place + "/game/Event.h")
        ours = types.SimpleNamespace(published=("Object.h", "Event.h"))
        said = report.Report(place)
        one = game.Game(place + "/game", place, ours, said, folder.Limits())
        one.copy_in()
        self.assertEqual((one.engine.files, one.files), (["Event.h", "dragonfly/Object.h"], ["Base.h"]))
        self.assertIn(("Thing.h", "a link to a file that was left out"), [(row.where, row.text) for row in said.rows])
        verdicts.Verdicts(one, None)  # must not fail because of the link

    def test_LinesAreCheckedAgainstTheEngineThatTheGameUses(self):
        """Prefers the author's own engine to a copy of the published one beside it, which has more headers."""
        place = tempfile.mkdtemp(dir=WORK)
        names = ["GameManager", "LogManager", "WorldManager"] + [f"Part{number}" for number in range(12)]
        header = {name: fixtures.engine_header(name) for name in names}
        sources = {f"mine/{name}.cpp": "" for name in names[:3]}
        for own, folder_checked in ((names[:12], "mine"), (names[:3], None), ([], "include")):
            files = {**{f"include/{name}.h": text for name, text in header.items()}, **{f"mine/{name}.h": header[name] for name in own}, **sources}
            fixtures.write(f"{place}/{len(own)}/game", files)
            one = game.Game(f"{place}/{len(own)}/game", f"{place}/{len(own)}", types.SimpleNamespace(published=[f"{name}.h" for name in names]),
                            report.Report(place), folder.Limits())
            one.copy_in()
            built = types.SimpleNamespace(compiler=types.SimpleNamespace(check_with=lambda unit, include: os.path.basename(include)))
            self.assertEqual(verdicts.Verdicts(one, built)._against_engine(None), folder_checked, own)

    def test_BesideAnEngineOfOnesOwnTheGameKeepsItsSources(self):
        core = {f"engine/{name}.cpp": "" for name in ("GameManager", "LogManager", "WorldManager", "Music")}
        game = {"Player.cpp": "df::Vector place;", "src/Path.cpp": "df::Vector step;", "Path.h": "class Path {};", "Player.h": "class Player {};"}
        own = {"more/Box.cpp": "namespace df { int x; }", "more/Shape.cpp": "df::Shape::Shape() {}", "src/ObjectList.cpp": ""}
        self.assertEqual(self.engine_files({**core, **game, **own}), sorted({**core, **own}))
        self.assertEqual(self.engine_files({**core, "engine/Button.h": "class Button {};", "engine/Button.cpp": "Button::Button() {}"}), sorted(core))


class TextTest(unittest.TestCase):
    """Tests how sources and compiler messages are read."""

    def test_CodeOnlyKeepsPlaces(self):
        source = 'a /* int main( */ "x\\"y" // z\nb \'"\' "open\nc /* to the end'
        code = text.code_only(source)
        self.assertEqual(len(code), len(source))
        self.assertEqual(code.split(), ["a", "b", "c"])

    def test_CodeThatIsNeverCompiledIsNoCode(self):
        for source, live in (("a\n#if 0\nb\n#if X\nc\n#else\nd\n#endif\ne\n#else\nf\n#endif\ng", "afg"), ("#if X\na\n#elif (0)\nb\n#endif\nc", "ac"),
                             ("#ifdef X\n# if false\na\n# endif\nb\n#endif\nc", "bc"), ("a\n#if 0\nb", "a"), ("#if 0 + X\na\n#endif\n#endif\nb", "ab"),
                             ("#if 0\na\n#elif 0\nb\n#else\nc\n#endif\nd", "cd")):
            code = text.code_only(source)
            self.assertEqual("".join(line for line in code.split("\n") if len(line) == 1 and line != " "), live, source)
            self.assertEqual([len(line) for line in code.split("\n")], [len(line) for line in source.split("\n")])

    def test_AByteOrderMarkIsNoPartOfTheFirstLine(self):
        place = made({"a.cpp": "\ufeffint a;\n", "b.cpp": "\ufeffint b;\n".encode("utf-16-le")})
        read = text.Sources(place, ["a.cpp", "b.cpp"])
        self.assertEqual((read.line("a.cpp", 1), read.line("b.cpp", 1), read.recoded), ("int a;", "int b;", ["b.cpp"]))
        with open(os.path.join(place, "a.cpp"), "rb") as file:
            self.assertEqual(file.read(), b"int a;\n")

    def test_ForeignTextCannotSpeakToTheTerminal(self):
        self.assertEqual(text.shown("a\x1b[2Jb\nc\u202e"), "a\\x1b[2Jb\\x0ac\\x2e")

    def test_DiagnosticsHaveNotesAndTheirFunction(self):
        found = compiler.parse("./a.cpp: In member function 'int A::f()':\n./a.cpp:3:5: error: 'X' is not a member of 'df'\n/u/h.h:1:2: note: here\n"
                               "./b c.h:7: warning: odd\n")
        self.assertEqual([(one.file, one.line, one.column, one.is_error) for one in found], [("a.cpp", 3, 5, True), ("b c.h", 7, 1, False)])
        self.assertEqual((found[0].within, found[0].notes), ("In member function 'int A::f()'"[3:], [("/u/h.h", "here", 1)]))

    def test_KeysAreThoseOfTheGameButNotThoseThatEndIt(self):
        found = keys.keys_of(["getKey() == df::Keyboard::Q || Keyboard::T || Keyboard :: Key::NUM1 || Keyboard::EventKeyboard"])
        self.assertEqual(found, ["NUM1", "T"])
        self.assertEqual(keys.random_script(found, 5, 60), keys.random_script(found, 5, 60))
        self.assertNotEqual(keys.random_script(found, 5, 60), keys.random_script(found, 6, 60))


class CompilerTest(unittest.TestCase):
    """Tests what is concluded from the way in which a run of the compiler ends."""

    def compiler(self, body, name="g++", seconds=20):
        place = made({name: "#!/bin/sh\n" + body + "\n", "include/Object.h": ""})
        os.chmod(os.path.join(place, name), 0o755)
        ours = types.SimpleNamespace(include="/ours")
        return compiler.Compiler(os.path.join(place, name), place, os.path.join(place, "objects"), ours, [], seconds=seconds)

    def check(self, body, seconds=20):
        one = self.compiler('test "$1" = --version && exit; ' + body, seconds=seconds)
        found = one.check_with(compiler.Unit("a.cpp"), os.path.join(one.root, "include"))
        return None if found is None else [diagnostic.text for diagnostic in found]

    def test_OnlyAWholeCheckSaysThatTheEngineInTheFolderTakesALine(self):
        error = "echo './a.cpp:1:1: error: wrong'; "
        self.assertEqual((self.check(error + "exit 1"), self.check("exit 0")), (["wrong"], []))
        for body in (error + "exit 4", error + "kill -9 $$", "exit 1", error + "yes './b.cpp:1:1: note: long' | head -200000; exit 1",
                     "echo \"$0\" | sed 's,g++$,include/Object.h:1:1: error: torn,'; exit 1", error + "exit 0"):
            self.assertIsNone(self.check(body), body)
        self.assertIsNone(self.check(error + "exec sleep 9", seconds=0.3))
        self.assertNotIn("max-errors=30", self.check("echo \"./a.cpp:1:1: error: $*\"; exit 1")[0])

    def test_OnlyProcessorTimeCountsAgainstTheBudget(self):
        for body, budget, too_long in (("exec sleep 1.2", 1, [False, False]), ("while :; do :; done", 9, [True, True]),
                                       ("exec sleep 0", 0, [True, True])):
            one = self.compiler('test "$1" = --version && exit; ' + body, seconds=1)
            one._limit = bounded.children_seconds() + budget
            units = [compiler.Unit("a.cpp"), compiler.Unit("b.cpp")]
            one.compile(units)
            self.assertEqual([unit.timed_out for unit in units], too_long, body)

    def test_ClangIsFoundByItsNameAndItsVersion(self):
        for name, body, is_gcc in (("clang++-14", "exit 1", False), ("c++", "echo 'Debian clang version 14'", False),
                                   ("g++", "echo 'g++ (Debian) 12'", True)):
            self.assertEqual(self.compiler(body, name).is_gcc, is_gcc, name)
        link = os.path.join(tempfile.mkdtemp(dir=WORK), "clang++")
        os.symlink(self.compiler("exit 1", "ccache").program, link)
        self.assertFalse(compiler.Compiler(link, WORK, os.path.join(WORK, "objects"), None, []).is_gcc)


class BlameTest(unittest.TestCase):
    """Tests to whom a fault is attributed: the game, another engine, another system or Naiad."""

    def blame(self, main_code):
        ours = types.SimpleNamespace(header_of=lambda name: None, was_published=lambda name, classes=(): False)
        return blame.Blame(ours, False, "", lambda unit: None, main_code)

    def test_NaiadIsBlamedOnlyForAPublishedNameThatItLacks(self):
        """The published engine has Object::setSprite, Object::shine, Grid and Grid.h. Naiad lacks the last three."""
        published = {"Grid", "Grid.h", "Object::setSprite", "Object::shine"}
        has = {"Object", "Vector", "setSprite", "setX", "sqrt"}

        def was_published(name, classes=()):
            return any(f"{one}::{name}" in published for one in classes) if classes else name in published

        ours = types.SimpleNamespace(has=lambda name: name in has, was_published=was_published,
                                     header_of=lambda name: f"/n/{name}.h" if name in ("Object", "Vector") else None)
        unit = compiler.Unit("a.cpp")
        accepts, refuses = lambda unit: [], lambda unit: None
        for message, with_engine, file, whose in (
                ("'class df::Object' has no member named 'shine'", refuses, "a.cpp", "Naiad"),
                ("'class Hero' has no member named 'shine'", refuses, "a.cpp", "Naiad or the game"),
                ("'class Hero' has no member named 'setSprite'", refuses, "a.cpp", "the game"),  # its base class is unknown
                ("'class df::Vector' has no member named 'setSprite'", refuses, "a.cpp", "the game"),
                ("no matching function for call to 'df::Object::setSprite(int)'", refuses, "a.cpp", "Naiad or the game"),
                ("no matching function for call to 'df::Object::shine(int)'", refuses, "a.cpp", "Naiad or the game"),  # so it has shine()
                ("'Grid' was not declared in this scope", refuses, "a.cpp", "Naiad or the game"),  # may be the game's own
                ("'Grid' is not a member of 'df'", refuses, "a.cpp", "Naiad"),
                ("Grid.h: No such file or directory", refuses, "a.cpp", "Naiad or the game"),
                ("Level.h: No such file or directory", refuses, "a.cpp", "the game"),
                ("format: No such file or directory", refuses, "a.cpp", "another system"),
                ("ncurses/curses.h: No such file or directory", refuses, "a.cpp", "another engine"),
                ("'level' was not declared in this scope", refuses, "a.cpp", "the game"),
                ("'class df::Object' has no member named 'myOwn'", accepts, "a.cpp", "Naiad or the game"),  # a changed copy of the engine
                ("expected unqualified-id before numeric constant", accepts, "/n/Object.h", "Naiad or the game"),  # a macro of the game
                ("expected ';'", accepts, "a.cpp", "Naiad or the game"), ("expected ';'", refuses, "a.cpp", "the game")):
            wrong = compiler.Diagnostic(file, 3, 1, "error", message, "")
            self.assertEqual(blame.Blame(ours, False, "", with_engine).error(unit, wrong, "x")[0], whose, message)
        elsewhere = compiler.Diagnostic("a.cpp", 9, 1, "error", "'class df::Object' has no member named 'myOwn'", "")
        wrong = compiler.Diagnostic("a.cpp", 3, 1, "error", elsewhere.text, "")
        self.assertEqual(blame.Blame(ours, False, "", lambda unit: [elsewhere]).error(unit, wrong)[0], "the game", "the engine lacks it, too")
        for symbol, whose in (("Object::setSprite(Sprite*)", "another engine"), ("Hero::jump()", "the game")):
            self.assertEqual(blame.Blame(ours, False, "", refuses, early=True).symbol(symbol)[0], whose, symbol)
        for symbol, whose in (("df::Grid", "Naiad"), ("df::Object::setSprite(float)", "Naiad or the game"), ("df::mine()", "the game"),
                              ("Hero::jump()", "the game")):
            self.assertEqual(blame.Blame(ours, False, "", refuses).symbol(symbol)[0], whose, symbol)

    def test_NamesOfOnesOwnEngineAreNoFaultOfTheGame(self):
        ours = types.SimpleNamespace(has=lambda name: name == "Vector", was_published=lambda name, classes=(): False, header_of=lambda name: None)
        for message, line, whose in (("cannot convert 'df::Place' to 'df::Vector'", "setPosition(start);", "another engine"),
                                     ("expected ')' before 'from'", "Bullet(df :: Place from);", "another engine"),
                                     ("expected ')' before 'from'", "Bullet(df::Vector from);", "the game"),
                                     ("expected ';' before '}'", "}", "the game")):
            wrong = compiler.Diagnostic("a.cpp", 1, 1, "error", message, "")
            for own in (True, False):
                one = blame.Blame(ours, own, "", lambda unit: None)
                self.assertEqual(one.error(compiler.Unit("a.cpp"), wrong, line)[0], whose if own else "the game", (message, own))

    def test_ACheckThatProvesNothingDoesNotMakeItTheGamesFault(self):
        """The engine in the folder has Grid, spin() and a parameter `place`; its headers do not compile."""
        ours = types.SimpleNamespace(has=lambda name: name == "Vector", was_published=lambda name, classes=(): False, header_of=lambda name: None)
        one = blame.Blame(ours, False, "class Grid; int spin(int place);", lambda unit: None)
        unclear = "Naiad or the game"
        for message, line, whose in (("'place' was not declared in this scope", "set(place);", "the game"),
                                     ("'Grid' is not a member of 'df'", "df::Grid place(1);", unclear),
                                     ("'place' was not declared in this scope", "set(place);", unclear),  # because of the line before
                                     ("'spin' was not declared in this scope", "spin(1);", unclear),
                                     ("'twist' was not declared in this scope", "twist(1);", "the game")):
            wrong = compiler.Diagnostic("a.cpp", 1, 1, "error", message, "")
            self.assertEqual(one.error(compiler.Unit("a.cpp"), wrong, line)[0], whose, message)
        wrong = compiler.Diagnostic("b.cpp", 1, 1, "error", "'place' was not declared in this scope", "")
        self.assertEqual(one.error(compiler.Unit("b.cpp"), wrong, "set(place);")[0], "the game")

    def test_EventsThatNothingRegistersForAreFound(self):
        place = tempfile.mkdtemp(dir=WORK)
        tests = "int Hero::eventHandler(const df::Event *p_e) {{\n  if (p_e->getType() == {}) return 1;\n  return 0;\n}}\n"
        for tested, rest, found in (("df::STEP_EVENT", "", ["STEP_EVENT"]), ("df::STEP_EVENT", "registerInterest(df::KEYBOARD_EVENT);", ["STEP_EVENT"]),
                                    ("STEP_EVENT", "p_hero->registerInterest( STEP_EVENT );", []), ("df::COLLISION_EVENT", "", []),
                                    ("df::MSE_EVENT", "// registerInterest(df::MSE_EVENT);", ["MSE_EVENT"]), ("df::STEP_EVENT", "registerInterest(type);", []),
                                    ("df::KEYBOARD_EVENT", 'registerInterest("nuke");', ["KEYBOARD_EVENT"]),
                                    ("df::KEYBOARD_EVENT", "class Name : public df::TextEntry {};", [])):
            fixtures.write(place, {"a.cpp": tests.format(tested), "b.cpp": rest})
            rows = blame.unregistered(text.Sources(place, ["a.cpp", "b.cpp"]), ["a.cpp", "b.cpp"])
            self.assertEqual(rows, [("a.cpp", 2, event) for event in found], (tested, rest))

    def test_AProgramThatBeginsInWinMainIsForAnotherSystem(self):
        line = "int WINAPI WinMain(HINSTANCE one) {"
        self.assertEqual(self.blame("int WinMain() {}").symbol("main")[0], "another system")
        self.assertEqual(self.blame("int tmain() {}").symbol("main"), ("the game", "no file of the program has a main()"))
        wrong = compiler.Diagnostic("a.cpp", 1, 1, "error", "expected initializer before 'WinMain'", "")
        self.assertEqual(self.blame(line).error(None, wrong, line)[0], "another system")

    def test_TheLineThatRunsTheGameIsNotBlamedForACrash(self):
        for code, whose in (("GM.run();", "Naiad or the game"), ("ship->fire();", "the game")):
            with tempfile.TemporaryDirectory(dir=WORK) as folder:
                one = running.Running.__new__(running.Running)
                one.folder, one._report = folder, unittest.mock.Mock()
                one._game = types.SimpleNamespace(sources=types.SimpleNamespace(line=lambda file, number, code=code: code))
                with unittest.mock.patch.object(one, "_crash_location", return_value=("game.cpp:43", "a bad pointer")):
                    one._report_crash(types.SimpleNamespace(log=""), None)
                self.assertEqual(one._report.add_left.call_args.args[:2], ("game.cpp:43", whose), code)


class MicrosoftTest(unittest.TestCase):
    """Tests how names of Visual Studio's templates and library are replaced."""

    def treated(self, *lines):
        place = made({"a.cpp": "\n".join(lines)})
        sources = text.Sources(place, ["a.cpp"])
        microsoft.treat(sources)
        return tuple(sources.text("a.cpp").split("\n"))

    def test_ItsNamesAreThoseOfCppUnlessTheGameHasItsOwn(self):
        self.assertEqual(self.treated('int _tmain(int c, _TCHAR* v[]) { puts(_T("_TCHAR")); } // _tmain'),
                         ('int main(int c, char* v[]) { puts("_TCHAR"); } // _tmain',))
        self.assertEqual(self.treated("int wmain(int c, wchar_t *v[]);", "wchar_t w; // _tmain"),
                         ("int main(int c, char *v[]);", "wchar_t w; // _tmain"))
        self.assertEqual(self.treated("  if (x) _CrtSetDbgFlag ( _CRTDBG_ALLOC | 1 );", "x = _stricmp(a, b);"),
                         ("  if (x) ;", "x = strcasecmp(a, b);"))
        for line, after in (("unsigned __int8 a; __int16 b; __int32 c; __int64 d;", "unsigned char a; short b; int c; long long d;"),
                            ("for each (Rock *p in rocks) p->fall();", "for (Rock *p : rocks) p->fall();"),
                            ("__declspec(align(16)) float x; __declspec(noinline) int __cdecl f();", " float x;  int  f();"),
                            ('throw std::exception("lost"); // std::exception("x")', 'throw std::runtime_error("lost"); // std::exception("x")'),
                            ("catch (std::exception &e) { throw std::exception(); }", "catch (std::exception &e) { throw std::exception(); }"),
                            ("virtual int draw() = NULL; virtual int size() const = NULL;", "virtual int draw() = 0; virtual int size() const = 0;"),
                            ("int *p = NULL;", "int *p = NULL;"), ("class Hero sealed {", "class Hero final {"),
                            ("int draw() override sealed;", "int draw() override final;"),
                            ('printf_s("%d", strtok_s(a, ",", &b) != 0);', 'printf("%d", strtok_r(a, ",", &b) != 0);'),
                            ('sscanf_s(line, "%d %f", &a, &b);', 'sscanf(line, "%d %f", &a, &b);'),
                            ('sscanf_s(line, "%s", name, 9);', 'sscanf_s(line, "%s", name, 9);'),
                            ("int WINAPI WinMain(HINSTANCE a, HINSTANCE b, LPSTR c, int d) {", "int main() {"),
                            ('puts("for each (a in b)"); /* __int64 */', 'puts("for each (a in b)"); /* __int64 */')):
            self.assertEqual(self.treated(line), (after,))
        for lines in (("#define _T(x) L##x", 'auto x = _T("a");'), ("typedef char TCHAR;", "TCHAR c;"),
                      ("#define _stricmp strcasecmp", "_stricmp(a, b);"), ('puts("TCHAR");', "int T_tmain;")):
            self.assertEqual(self.treated(*lines), lines)


class TreatmentTest(unittest.TestCase):
    """Tests which lines are changed and which are left as they are."""

    def treated(self, line, message, column):
        place = made({"a.cpp": line})
        sources, unit = text.Sources(place, ["a.cpp"]), compiler.Unit("a.cpp")
        unit.diagnostics = [compiler.Diagnostic("a.cpp", 1, column, "error", message, "")]
        ours = types.SimpleNamespace(header_of=lambda name: "/ours/" + name + ".h")
        treatments.Treatments(sources, types.SimpleNamespace(definitions=[]), ours).treat([unit])
        return sources.line("a.cpp", 1)

    def test_ABaseGetsItsNamespaceOnce(self):
        for before, after in (("class A : public Thing {", "class A : public df::Thing {"),
                              ("class A : public df::Thing {", "class A : public df::Thing {")):
            self.assertEqual(self.treated(before, "expected class-name before '{' token", before.index("{") + 1), after)

    def test_RemaindersOfCoordinatesAreThoseOfIntegers(self):
        gcc, clang = "invalid operands of types '{}' and '{}' to binary 'operator%'", "invalid operands to binary expression ('{}' and '{}')"
        for before, types_, after in (("a = rand() % box.getX();", ("int", "float"), "a = rand() %(int) box.getX();"),
                                      ("a = rand()%w;", ("int", "float"), "a = rand()%(int)w;"),
                                      ("a = w % w;", ("float", "float"), "a = w %(int) w;"),
                                      ("a = 1 + p->at(2).x % 3;", ("float", "int"), "a = 1 + (int)p->at(2).x % 3;"),
                                      ("a = getX() % 3;", ("float", "int"), "a = (int)getX() % 3;"), ("a %= w;", ("int", "float"), "a %= w;"),
                                      ("a = p % 3;", ("df::Vector", "int"), "a = p % 3;")):
            for message in (gcc, clang):
                self.assertEqual(self.treated(before, message.format(*types_), before.index("%") + 1), after, message)

    def test_EnginesHeadersAreWrittenAsTheyAre(self):
        place = made({"a.cpp": '#include "../dragonfly/Vector.h"\n#include "OBJECT.H"\n'})
        sources = text.Sources(place, ["a.cpp"])
        includes.Includes(sources, [], types.SimpleNamespace(headers=["Object.h", "Vector.h", "vector.h"]), []).treat()
        self.assertEqual((sources.line("a.cpp", 1), sources.line("a.cpp", 2)), ('#include "Vector.h"', '#include "Object.h"'))


class TrialTest(unittest.TestCase):
    """Tests what is concluded from the ends of the game and of its player. Both are shell scripts."""

    GAME = 'trap "{}" TERM; echo 9 >$NAIAD_PORT_FILE; while :; do sleep 0.05; done\n'
    LOST = "bot lost ticks=50 objects=3"

    def outcome(self, game, *answers, seconds=2.5):
        """Runs `game`, and as its players the scripts `answers`, of which the last one is repeated."""
        place = tempfile.mkdtemp(dir=WORK)
        bots = {f"bot{number}": answer + "\n" for number, answer in enumerate(answers)}
        count = f"n=$(ls {place}/ran | wc -l); touch {place}/ran/$n; test -e {place}/bot$n || n={len(answers) - 1}; . {place}/bot$n\n"
        fixtures.write(place, {"dfbot": "#!/bin/sh\n" + count, "tree/game": "#!/bin/sh\n" + game, "ran/.keep": "", **bots})
        for name in ("dfbot", "tree/game"):
            os.chmod(os.path.join(place, name), 0o755)
        one = trial.Trial(place + "/tree", "game", "", types.SimpleNamespace(lib=place, bin=place), seconds, 1, None, [])
        with unittest.mock.patch.object(trial, "END_SECONDS", 0.5):
            return one.run(os.path.join(place, "root"), confined=False)

    def test_APlayerWhoLostTheConnectionJoinsAgainWhileTheGameRuns(self):
        one = self.outcome(self.GAME.format("exit 0"), f"echo {self.LOST}; exit 4", "echo bot ok clients=1 ticks=70 objects=5; exit 0", seconds=30)
        self.assertEqual((one.state, one.ticks, one.objects, one.runs), ("played", 120, 5, True))
        one = self.outcome(self.GAME.format("exit 0"), f"echo {self.LOST}; echo The game is over.; exit 4", seconds=1.5)
        self.assertEqual((one.state, one.ticks >= 50, one.runs), ("played", True, True))

    def test_TicksOfARoundWhosePlayerWasLostCount(self):
        one = self.outcome("echo 9 >$NAIAD_PORT_FILE; until test -e ../../ran/0; do sleep 0.05; done; sleep 0.4; exit 0\n",
                           f"sleep 0.3; echo {self.LOST}; exit 4", seconds=1.2)
        self.assertEqual((one.state, one.runs, one.ticks % 50), ("over", True, 0))
        self.assertGreaterEqual(one.ticks, 50)

    def test_OnlyAGameThatDoesNotFinishATickHangs(self):
        forced = "forced to exit: the game does not finish tick 51, while Ship handles EventStep"
        one = self.outcome(self.GAME.format(f"echo {forced}; exit 1"), f"echo {self.LOST}; exit 4", "sleep 9", seconds=1.2)
        self.assertEqual((one.state, one.text, one.runs), ("hangs", forced.removeprefix("forced to exit: "), False))
        one = self.outcome(self.GAME.format("exit 0"), "echo The server is full.; exit 4", seconds=1.2)
        self.assertEqual((one.state, one.text, one.runs), ("refused", "The server is full.", False))
        one = self.outcome(self.GAME.format(":"), "echo bot ok clients=1 ticks=70 objects=5; exit 0", seconds=1)
        self.assertEqual((one.state, one.runs, one.ended_well), ("played", True, False))
        one = self.outcome(self.GAME.format(":"), f"echo {self.LOST}; exit 4", "exit 4", seconds=1.2)
        self.assertEqual((one.state, one.runs), ("hangs", False))


class FilesTest(unittest.TestCase):
    """Tests which files a game is found to load."""

    def test_OfEqualFoldersTheLikeliestIsTheOneToRunIn(self):
        code = 'RM.loadSprite("sprites/hero.txt", "hero");'
        appended = 'RM.loadSprite(std::string("levels\\\\") + name, "level");'
        for main, others, folder_ in (("src/game.cpp", ("game/sprites/hero.txt", "backup/sprites/hero.txt"), "game"),
                                      ("game.cpp", ("Debug/sprites/hero.txt", "sprites/hero.txt"), ""),
                                      ("z/src/game.cpp", ("a/sprites/hero.txt", "z/bin/sprites/hero.txt"), "z/bin"),
                                      ("src/game.cpp", ("a/sprites/hero.txt", "b/sprites/hero.txt", "b/df-config.txt"), "b"),
                                      ("src/game.cpp", ("a/sprites/hero.txt", "b/sprites/hero.txt", "b/game.vcxproj"), "b"),
                                      ("src/game.cpp", ("a/sprites/hero.txt", "b/sprites/hero.txt", "b/levels/1.txt"), "b"),
                                      ("src/game.cpp", ("a/sprites/hero.txt", "b/sprites/hero.txt", "b/sprites/rock.txt"), "b")):
            place = tempfile.mkdtemp(dir=WORK)
            used = code + ('RM.loadSprite("sprites/rock.txt", "rock");' if "b/sprites/rock.txt" in others else "")
            fixtures.write(place, {main: used + (appended if "b/levels/1.txt" in others else "")})
            program = programs.Program(main, [main], None, [])
            self.assertEqual(filenames.run_folder([main, *others], text.Sources(place, [main]), program), folder_, others)

    def test_WhatDeadCodeLoadsIsNotMissing(self):
        place = tempfile.mkdtemp(dir=WORK)
        line = 'RM.loadSprite("{}.txt", "x");'
        code = "\n".join(("/*", line.format("a"), "*/", "#if 0", line.format("b"), "#else", line.format("c"), "#endif",
                          'LM.writeLog("// %d", 1); ' + line.format("d"), "// " + line.format("e"), ""))
        fixtures.write(place, {"game.cpp": code})
        missing = filenames.missing_files([], text.Sources(place, ["game.cpp"]), ["game.cpp"], "")
        self.assertEqual(missing, [("game.cpp", 7, "c.txt", ""), ("game.cpp", 9, "d.txt", "")])

    def test_AFileThatLiesElsewhereIsNamed(self):
        place = made({"game.cpp": 'RM.loadSprite("C:\\\\Users\\\\bob\\\\hero-spr.txt", "hero");'})
        missing = filenames.missing_files(["run/sprites/Hero-spr.txt"], text.Sources(place, ["game.cpp"]), ["game.cpp"], "run")
        self.assertEqual(missing[0][3], "sprites/Hero-spr.txt")

    def test_OnlySpritesThatWereRefusedAreTheGamesFault(self):
        log = "10 Sprite hero: /game/sprites/hero.txt:4: slowdown has no number, 0 is used (compat)\n" \
              "11 Sprite wall: sprites/wall.txt:7: the row has 2 characters instead of 3\n"
        self.assertEqual(filenames.refused_sprites(log, "run"), [("run/sprites/wall.txt", "7", "the row has 2 characters instead of 3")])


class BoundedTest(unittest.TestCase):
    """Tests that commands end together with the processes that they started."""

    def test_EndlessOutputAndTimeAreCut(self):
        done = bounded.run(["/bin/sh", "-c", "yes & yes"], timeout=0.5)
        self.assertTrue(done.timed_out)
        self.assertLessEqual(len(done.output), bounded.MAX_OUTPUT)

    def test_ALoadedMachineGivesACommandMoreTime(self):
        self.assertFalse(bounded.run(["/bin/sh", "-c", "exec sleep 1.2"], timeout=1).timed_out)
        began = time.monotonic()
        self.assertTrue(bounded.run(["/bin/sh", "-c", "exec sleep 9"], timeout=0.1).timed_out)
        self.assertLess(time.monotonic() - began, 8)
        self.assertTrue(bounded.run(["/bin/sh", "-c", "while :; do :; done"], timeout=1).timed_out)

    def test_LowerLimitsOfTheSystemStay(self):
        done = run_as_user(self, LIMITED)
        self.assertEqual(done.stdout, "(100, 100) 1024 (60, 60)\n", done.stderr)

    def test_ACopyHasALimitOfFilesAndBytes(self):
        place = made({f"{number}.txt": "x" * 600 for number in range(20)})
        copy = folder.copy_folder(place, place + ".copy", folder.Limits(entries=10, total_bytes=3000))
        self.assertEqual(len(copy.files), 5)
        self.assertEqual([reason for _, reason in copy.left_out][-1], "this and all files after it: more than 10 files")
