"""Small games with one construct each, as {file: text}. Text is written as UTF-8 unless it is bytes."""
import os

MAIN = """#include "GameManager.h"
#include "LogManager.h"
#include "ResourceManager.h"
#include "WorldManager.h"
#include "Hero.h"
int main(int argc, char *argv[]) {
  if (GM.startUp()) return 1;
  RM.loadSprite("sprites/hero-spr.txt", "hero");
  new Hero;
  GM.run();
  GM.shutDown();
  return 0;
}
"""
HERO_H = """#include "EventKeyboard.h"
#include "Object.h"
class Hero : public df::Object {
 public:
  Hero();
  int eventHandler(const df::Event *p_e);
};
"""
HERO = """#include "Hero.h"
Hero::Hero() { setSprite("hero"); setPosition(df::Vector(10, 10)); registerInterest(df::KEYBOARD_EVENT); }
int Hero::eventHandler(const df::Event *p_e) {
  if (p_e->getType() != df::KEYBOARD_EVENT) return 0;
  const auto *p_k = dynamic_cast<const df::EventKeyboard *>(p_e);
  if (p_k->getKey() == df::Keyboard::RIGHTARROW) setPosition(getPosition() + df::Vector(1, 0));
  return 1;
}
"""
SPRITE = "frames 1\nwidth 3\nheight 1\ncolor green\n<=>\nend\neof\n"

# A single file, because one compilation then reports everything. None of its problems is the engine's fault.
ALONE = """#include "GameManager.h"
#include "Object.h"
#include "WorldManager.h"
"""


def write(folder, files):
    """Writes these files into a folder."""
    for name, text in files.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode("utf-8"))


def engine_header(name):
    """Returns text that resembles a header of a copy of the published engine. It does not compile."""
    return f"#pragma once\nnamespace df {{\nclass {name} {{ a copy that must not be taken }};\n}}\n"


# A game that was written with Visual Studio on Windows, contains a copy of the engine, and was packed on a Mac.
WINDOWS = {
    "src/game.cpp": MAIN.replace('"Hero.h"', '"..\\Things\\hero.H"').replace('"WorldManager.h"', '"worldmanager.h"')
    .replace("int main(int argc, char *argv[])", "#include <Player.h>\nint _tmain(int argc, _TCHAR *argv[])")
    .replace("new Hero;", "new Hero; (new Player)->start();"),
    "Things/Hero.h": """\ufeff#include "stdafx.h"
#include "../dragonfly/include/EventKeyboard.h"
#include "../dragonfly/include/Object.h"
class Hero : public df::Object {
 public:
  Hero();
  int Hero::eventHandler(const df::Event *p_e);
  const Vector &home() const;
 private:
  df::Vector m_home;
};
""",
    "Things/Hero.cpp": HERO.replace("  return 1;\n}", "}") + "const df::Vector &Hero::home() const { return m_home; }\n",
    # Naiad has a header of this name, too.
    "Things/Player.h": "#include \"Object.h\"\nusing namespace df;\nclass Player : public Object { public: Vector start() const; };\n",
    "Things/Player.cpp": "#include \"player.h\"\nVector Player::start() const { return df::Vector(1, ROCKS); }\n"
                         "#if defined(WIN32)\n#error\n#endif\n",
    "Things/Unused.cpp": "this is not C++\n",
    "dragonfly/include/Object.h": engine_header("Object"),
    "dragonfly/include/EventKeyboard.h": engine_header("EventKeyboard"),
    "dragonfly/lib/libdragonfly-linux64.a": b"!<arch>\n",
    "__MACOSX/src/._game.cpp": b"\0\5\26\7",
    "src/._game.cpp": b"\0\5\26\7",
    "Makefile": "CXXFLAGS= -g -DROCKS=5 -DWIN32\nGAMESRC= Things/Hero.cpp Things/Player.cpp\nGAME= src/game.cpp\nX := $(shell touch SHELL_RAN)\n"
                "all: $(GAMESRC:.cpp=.o)\n\tg++ $(GAME) $(GAMESRC) -ldragonfly; touch RECIPE_RAN\ndepend:\n\tmakedepend *.cpp Things/*.cpp\n",
    "sprites/hero-spr.txt": SPRITE,
}

# A game for an early engine, in UTF-16 as Visual Studio may save it.
EARLY = {
    "game.cpp": ("\ufeff" + ALONE + """class Hero : public df::Object {
 public:
  void draw() { DM.drawCh(getPosition(), '@', df::WHITE); }
};
int main() { GM.startUp(); (new Hero)->setPosition(df::Vector(5, 5)); GM.run(); GM.shutDown(); return 0; }
""").replace('#include "Object.h"', '#include "DisplayManager.h"\n#include "Object.h"').encode("utf-16-le"),
}

MISSING_SPRITE = {
    "run it/game.cpp": ALONE.replace("Object.h", "ResourceManager.h") + """int main() {
  GM.startUp();
  RM.loadSprite("sprites/not-there.txt", "hero");
  RM.loadSprite("sprites/torn-spr.txt", "torn");
  // RM.loadSprite("sprites/commented.txt", "out");
  RM.loadSprite("sprites/odd-spr.txt", "odd");
  GM.run();
  GM.shutDown();
}
""",
    # The published engine accepts a sprite in this format.
    "run it/sprites/odd-spr.txt": "frames 1\nwidth 1\nheight 1\ncolor green\nslowdown\n@\nend\neof\n",
    "run it/sprites/torn-spr.txt": "frames 1\nwidth 3\nheight 2\ncolor green\n<=>\n<=\nend\neof\n"}

NETWORK = {
    "game.cpp": ALONE + '#include "Net.h"\nint main() { GM.startUp(); Net net; GM.run(); GM.shutDown(); return 0; }\n',
    "Net.h": "#pragma once\n#include <winsock2.h>\nclass Net { SOCKET s; public: Net(); };\n",
    "Net.cpp": '#include "Net.h"\nNet::Net() { WSADATA d; WSAStartup(MAKEWORD(2, 2), &d); }\n'}

CRASH = {
    "game.cpp": ALONE + """#include "ResourceManager.h"
void greet(df::Sound *p_sound) {
  p_sound->play();
}
int main() {
  GM.startUp();
  int *p_lives = nullptr;
  *p_lives = 3;
  GM.run();
}
"""}

NO_RUN = {"game.cpp": ALONE + "int main() { GM.startUp(); new df::Object; GM.shutDown(); return 0; }\n"}

NO_FILE = {"game.cpp": '#include "GameManager.h"\n#include "Level.h"\nint main() { GM.startUp(); Level level; GM.run(); }\n'}

# A game for its author's own engine, which has functions that the published engine lacks.
OWN_ENGINE = {
    "game.cpp": ALONE + """int main() {
  GM.startUp();
  WM.startTheParty(3);
  GM.run();
}
""",
    **{f"engine/{name}.h": f"namespace df {{ class {name} {{ public: void startTheParty(int); }}; }}\n"
       for name in ("GameManager", "WorldManager", "LogManager", "DisplayManager", "Object")},
    **{f"engine/{name}.cpp": f'#include "{name}.h"\nvoid df::{name}::startTheParty(int) {{}}\n'
       for name in ("GameManager", "WorldManager", "LogManager", "DisplayManager", "Object")}}

# A game with an outdated Makefile, which lacks a needed file and lists an unused one.
STALE_LIST = {"game.cpp": MAIN, "Hero.h": HERO_H, "Hero.cpp": HERO, "sprites/hero-spr.txt": SPRITE,
              "Old.cpp": '#include "Forgotten.h"\nForgotten forgotten;\n', "Makefile": "game: game.cpp\n\tg++ game.cpp Old.cpp -o game\n"}

# A folder with many leftover copies and no Makefile or project file that lists the files of the game.
COPIES = {
    "src/game.cpp": MAIN.replace('#include "Hero.h"', '#include "Hero.h"\n#include "Points.cpp"'), "src/Points.cpp": "int points() { return 3; }\n",
    "src/include/Hero.h": HERO_H, "src/Hero.Cpp": HERO, **{f"src/Hero{suffix}.cpp": HERO for suffix in (" - Copy", " copy", " (1)", "_old")},
    "old/Hero.h": "this is no C++ yet\n", "old/Hero.cpp": HERO,
    "tests/HeroTest.cpp": '#include "../src/include/Hero.h"\nHero::Hero() {}\nint Hero::eventHandler(const df::Event *p_e) { return 7; }\n'}

# Two programs in one folder. One of them only makes an Object and is not the game.
TWO_MAINS = {"Driver.cpp": '#include "hero.h"\nint main() { Hero hero; return 0; }\n', "main.cpp": MAIN, "hero.h": HERO_H, "hero.cpp": HERO,
             "Again.cpp": '#include "GameManager.h"\nvoid again() { GM.run(); }\n'}

# A game in the folders of a Visual Studio project, with calls of its tools that report memory leaks.
STUDIO = {
    "Project 1/Game/Game.vcxproj": '<ClCompile Include="main.cpp" />\r\n<ClCompile Include="Source Files\\Hero.cpp" />',
    "Project 1/Game/main.cpp": "#include <vld.h>\n#include <crtdbg.h>\n" +
    MAIN.replace("  GM.shutDown();", "  GM.shutDown();\n  _CrtDumpMemoryLeaks();"),
    "Project 1/Game/Header Files/Hero.h": HERO_H.replace('"Object.h"', '"../../dragonfly/include/object.h"'),
    "Project 1/Game/Source Files/Hero.cpp": HERO.replace("return 0;", 'return _stricmp("a", "A");')}

# Constructs that only MSVC or early engines accept, with the text of the changed line; None: the line stays as it is.
MSVC = {
    "extra": ("struct A {\n  int A::get() { return 1; }\n};\n", {2: "int get() { return 1; }"}),
    "const": ("const const int g_one = 1;\nint const const *two();\nconst int const three = 3;\n",
              {1: "const int g_one = 1;", 2: "int const *two();", 3: "const int three = 3;"}),
    "enum": ("class A {\n public:\n  enum Unknown m_kind;\n};\nint kind(A a) { return a.m_kind; }\n", {3: "int m_kind;"}),
    "later": ("enum Later;\nenum Later f_later();\nenum Later { FIRST };\nenum Later f_later() { return FIRST; }\n",
              {1: "enum Later : int;", 3: "enum Later : int { FIRST };"}),
    "header": ('enum Shade shade();\n#include "Shade.h"\nenum Shade shade() { return DARK; }\n', {1: '#include "Shade.h"'}),
    "typename": ("#include <vector>\ntemplate <class T>\nint f_typename(T t) {\n  T::value_type a = t[0];\n  return a;\n}\n"
                 "int g_typename() { return f_typename(std::vector<int>(1)); }\n", {4: "typename T::value_type a = t[0];"}),
    "int64": ("__int64 big = 1; unsigned __int64 bigger = 2;\n", {1: "long long big = 1; unsigned long long bigger = 2;"}),
    "secure": ('#include "StandardHeaders.h"\nint f_secure(char *p) {\n  char name[9];\n  errno_t wrong = strcpy_s(name, p);\n'
               '  strncpy_s(name, 9, p, 3);\n  strcat_s(name, "x");\n  sprintf_s(name, "%d", 1);\n  printf_s("%s", name);\n'
               "  return wrong;\n}\n", {8: 'printf("%s", name);'}),
    "each": ("#include <vector>\nint f_each(std::vector<int> all) {\n  int sum = 0;\n  for each (int one in all) sum += one;\n  return sum;\n}\n",
             {4: "for (int one : all) sum += one;"}),
    "temporary": ("struct V { int x; };\nint x(V &v) { return v.x; }\nV make() { return V(); }\nint f_temporary() {\n  V &v = make();\n  return v.x + x(V());\n}\n",
                  {2: "int x(const V &v) { return v.x; }", 5: "V &&v = make();"}),
    "member": ("struct A { int f() { return 1; } };\nint g_member(A a) {\n  int (A::*p)() = A::f;\n  return (a.*p)();\n}\n", {3: "int (A::*p)() = &A::f;"}),
    "exception": ('#include <stdexcept>\nvoid f_exception() { throw std::exception("lost"); }\n', {2: 'void f_exception() { throw std::runtime_error("lost"); }'}),
    "pure": ("#include <cstddef>\nstruct A { virtual int f_pure() = NULL; };\n", {2: "struct A { virtual int f_pure() = 0; };"}),
    "final": ("class A sealed { virtual int f_final() sealed { return 1; } };\n", {1: "class A final { virtual int f_final() final { return 1; } };"}),
    "declspec": ("__declspec(dllexport) int __cdecl f_declspec() { return 1; }\n__forceinline int g_declspec() { return f_declspec(); }\n",
                 {1: "int  f_declspec() { return 1; }", 2: "inline int g_declspec() { return f_declspec(); }"}),
    "implicit": ("static f_implicit() { return 1; }\nint g_implicit() { return f_implicit(); }\n", {1: None}),
    "jump": ("int f_jump(int a) {\n  if (a) goto end;\n  int b = 2;\n  a += b;\nend:\n  return a;\n}\n", {3: "int b; b = 2;"}),
    "default": ("int f_default(int a = 1);\nint f_default(int a = 1) { return a; }\n", {2: None}),
    "static": ("struct A { static const float f = 1.5f; static int g_static(); };\nstatic int A::g_static() { return 1; }\n", {1: None, 2: None}),
    "base": ("template <class T> struct A { int get() { return 1; } };\ntemplate <class T> struct B : A<T> { int f() { return get(); } };\n"
             "int g_base(B<int> b) { return b.f(); }\n", {2: None}),
    "throw": ("#include <memory>\nint f_throw() throw(int);\nint f_throw() throw(int) { return 1; }\n", {}),
    "position": ('#include <cstdlib>\n#include "Object.h"\nstruct Shot {\n  Shot(df::Position from, df::EventView);\n};\n'
                 "Shot::Shot(df::Position from, df::EventView) { from.setX(rand() % from.getX()); }\n",
                 {4: None, 6: "Shot::Shot(df::Position from, df::EventView) { from.setX(rand() %(int) from.getX()); }"}),
    "windows": ('#include <WINDOWS.H>\n#include <winuser.h>\n#include <mmsystem.h>\n#include <conio.h>\n#include <io.h>\n'
                "int WINAPI_f() {\n  Sleep(10); _getch(); kbhit(); Beep(1, 2);\n"
                '  if (MessageBox(NULL, "a", TEXT("b"), MB_OK | MB_ICONERROR) == IDOK) PlaySound("x.wav", NULL, SND_ASYNC | SND_FILENAME);\n'
                "  HANDLE console = GetStdHandle(STD_OUTPUT_HANDLE);\n  COORD at = {1, 2};\n  SetConsoleCursorPosition(console, at);\n"
                "  if (GetAsyncKeyState(VK_LEFT) & 0x8000) return max(1, 2.5);\n  return (int)min(GetTickCount(), 7u);\n}\n",
                {1: '#include "Windows.h"', 2: '#include "windows.h"', 3: '#include "windows.h"', 4: None, 5: "//#include <io.h>", 7: "Sleep(10); _getch(); _kbhit(); Beep(1, 2);"})}

MSVC_GAME = {"game.cpp": ALONE + "int WINAPI WinMain(HINSTANCE one, HINSTANCE two, LPSTR line, int show) { GM.startUp(); GM.run(); GM.shutDown(); }\n",
             "Shade.h": "#pragma once\nenum Shade { DARK };\n", **{f"{name}.cpp": code for name, (code, _) in MSVC.items()}}

# A game that tries everything that the sandbox forbids, and prints which attempts succeeded.
PRISONER = {
    "game.cpp": ALONE + r"""#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <unistd.h>
struct Prisoner : df::Object {};
int main() {
  GM.startUp();
  const char *places[] = {"/usr/naiad-adopt", "/etc/naiad-adopt", "/home/naiad-adopt", OUTSIDE "/escaped"};
  for (const char *place : places) {
    // In the sandbox /etc is a folder in memory.
    if (open(place, O_CREAT | O_WRONLY, 0600) >= 0 && std::string(place).find("/etc") != 0) printf("WROTE %s\n", place);
  }
  if (open(OUTSIDE "/secret", O_RDONLY) >= 0) printf("READ secret\n");
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(PORT);
  inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  if (connect(socket(AF_INET, SOCK_STREAM, 0), (sockaddr *)&to, sizeof to) == 0) printf("CONNECTED\n");
  if (mount(nullptr, "/usr", nullptr, MS_REMOUNT | MS_BIND, nullptr) == 0) printf("MOUNTED\n");
  if (fork() == 0) {
    setsid();
    for (;;) pause();
  }
  fflush(stdout);
  printf("TRIED\n");
  fflush(stdout);
  return 3;
}
"""}

# A game with names without df::, with names whose headers were once included indirectly, an accidentally private base,
# enumerators of a scoped type, a name of both game and engine, a setter and main() of other types, draw() of an early engine and
# of today's, code that only MSVC accepts, and an unused source.
NAMES = {
    "game.cpp": ALONE + """#include <math.h>
class Contact { public: int touch() { return 1; } };
using namespace df;
Contact first_contact;
void main() {
  GM.startUp();
  GM.run();
  GM.shutDown();
}
""",
    "Hero.cpp": """#include "Hero.h"
Hero::Hero() { setPosition(Vector(1, 2) + Vector(3, 4)); }
int Hero::eventHandler(const df::Event *p_e) {
  const df::EventStep *p_s = (const df::EventStep *)p_e;
  if (p_s->getStepCount() == strlen("x")) return (int)df::SYNC_OBJECT;
  return 0;
}
df::Object *made() { return new Thing; }
struct Crate : df::Object { int draw() { return 0; } };
struct Wall : df::Object {
  void draw() {
    if (!isActive()) return;
  }
};
int count(int n = 1);
int count(int n = 1) { return n; }
df::Object *built() { return new Wall; }
""",
    "Hero.h": """#include "Object.h"
#include "NetworkNode.h"
class Hero : public Object {
 public:
  Hero();
  int eventHandler(const df::Event *p_e);
  void setActive(bool active) {}
};
class Thing : df::Object {};
""",
    "Old.cpp": '#include "Forgotten.h"\nForgotten forgotten;\n'}

# A game with a copy of the engine's headers, which have a name that Naiad lacks. (Here it is a name that no engine has.)
BUNDLE = {
    "game.cpp": """#include "GameManager.h"
#include "Object.h"
int main() {
  GM.startUp();
  df::Object hero;
  hero.shineLikeInRelease99();
  hero.misspelt();
  GM.run();
}
""",
    "df/include/GameManager.h": "#pragma once\n#define GM df::GameManager()\n"
                                "namespace df { class GameManager { public: int startUp(); void run(); }; }\n",
    "df/include/Object.h": "#pragma once\nnamespace df { class Object { public: int shineLikeInRelease99(); }; }\n",
    **{f"df/include/{name}.h": f"#pragma once\nnamespace df {{ class {name} {{}}; }}\n"
       for name in ("WorldManager", "LogManager", "Event", "Box", "Vector", "Sprite", "Frame", "Music", "Sound", "Clock")}}
