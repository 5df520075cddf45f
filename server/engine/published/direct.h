// Stands in for Microsoft's header of this name, which games include for _getcwd().
#pragma once

#include <sys/stat.h>
#include <unistd.h>

inline char* _getcwd(char* path, int size) {
  return getcwd(path, static_cast<decltype(sizeof(0))>(size));
}
inline int _chdir(const char* path) {
  return chdir(path);
}
inline int _mkdir(const char* path) {
  return mkdir(path, 0777);
}
