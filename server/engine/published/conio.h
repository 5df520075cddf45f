// Stands in for Microsoft's header of this name: no key is ever waiting, because keys come as events.
#pragma once

inline int _kbhit() {
  return 0;
}
inline int _getch() {
  return -1;
}
