// Stands in for the Windows header of this name, which games made on Windows include, mostly without need.
// Keys come as events and time is game time, so nothing here waits or asks the operating system.
#pragma once

#include <algorithm>

#include "GameManager.h"
#include "StandardHeaders.h"

using BOOL = int;
using BYTE = unsigned char;
using WORD = unsigned short;
using DWORD = unsigned int;

#if !defined(TRUE)
#define TRUE 1
#define FALSE 0
#endif

using std::max;
using std::min;

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
