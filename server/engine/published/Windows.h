// Stands in for the Windows header of this name, which games made on Windows include, mostly without need.
// Keys come as events and time is game time, so nothing here waits or asks the operating system.
#pragma once

#include <type_traits>

#include "GameManager.h"
#include "StandardHeaders.h"

using BOOL = int;
using BYTE = unsigned char;
using DWORD = unsigned int;
using HANDLE = void*;
using LPCSTR = const char*;
using WORD = unsigned short;

struct COORD {
  short X, Y;
};

#if !defined(TRUE)
#define TRUE 1
#define FALSE 0
#endif
#if !defined(TEXT)
#define TEXT(text) text
#endif

enum { MAX_PATH = 260, MB_OK = 0, MB_OKCANCEL = 1, MB_YESNO = 4, MB_ICONERROR = 16, IDOK = 1, IDYES = 6 };
enum { SND_SYNC = 0, SND_ASYNC = 1, SND_LOOP = 8, SND_FILENAME = 0x20000, STD_OUTPUT_HANDLE = -11 };
enum { VK_RETURN = 13, VK_ESCAPE = 27, VK_SPACE = 32, VK_LEFT = 37, VK_UP, VK_RIGHT, VK_DOWN };

/// The greater or smaller one, of different types, too.
template <class A, class B>
constexpr typename std::common_type<A, B>::type max(A a, B b) {
  return a < b ? b : a;
}
template <class A, class B>
constexpr typename std::common_type<A, B>::type min(A a, B b) {
  return b < a ? b : a;
}

/// A function that accepts any arguments, does nothing and returns 1.
struct DfDoesNothing {
  template <class... Arguments>
  int operator()(const Arguments&... /*any*/) const {
    return 1;
  }
};
constexpr DfDoesNothing MessageBox{}, MessageBoxA{}, OutputDebugString{}, PlaySound{}, PlaySoundA{},
    ShowWindow{}, SetConsoleCursorPosition{}, SetConsoleTextAttribute{}, SetConsoleTitle{},
    SetConsoleTitleA{};
inline HANDLE GetStdHandle(int /*number*/) {
  return nullptr;
}

/// Returns at once.
inline void Sleep(DWORD /*milliseconds*/) {}
inline BOOL Beep(DWORD /*frequency*/, DWORD /*milliseconds*/) {
  return TRUE;
}
/// Returns 0: no key is ever down.
inline short GetAsyncKeyState(int /*key*/) {
  return 0;
}
inline short GetKeyState(int /*key*/) {
  return 0;
}
/// Returns milliseconds of game time.
inline DWORD GetTickCount() {
  return static_cast<DWORD>(GM.getStepCount()) * static_cast<DWORD>(GM.getFrameTime());
}
inline void OutputDebugStringA(const char* /*text*/) {}
