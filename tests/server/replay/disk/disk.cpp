// A preloaded library with which a server's disk seems to stall, to be full, or not to be writable, for round
// files (.dfr) only. $DF_TEST_DISK is a folder with these files:
//
//   stall, full, read-only   while the file exists, calls wait, or fail with ENOSPC or EROFS
//   stalled                  created when a call begins to wait
//   syncs                    a SyncNote for each sync
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "tests/server/replay/disk/SyncNote.h"

namespace {

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool isRound(const char* path) {
  const size_t length = strlen(path);
  return length > 4 && strcmp(path + length - 4, ".dfr") == 0;
}

bool isRound(int file) {
  char link[64];
  char path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0) return false;
  path[length] = '\0';
  return isRound(path);
}

bool pathOf(const char* name, char (&path)[4096]) {
  const char* folder = getenv("DF_TEST_DISK");
  return folder != nullptr && snprintf(path, sizeof path, "%s/%s", folder, name) < 4096;
}

bool isThere(const char* name) {
  char path[4096];
  return pathOf(name, path) && access(path, F_OK) == 0;
}

void append(const char* name, const void* bytes, size_t size) {
  static const auto real_write = next<ssize_t (*)(int, const void*, size_t)>("write");
  char path[4096];
  if (!pathOf(name, path)) return;
  const int file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = real_write(file, bytes, size);
  close(file);
}

int64_t nanos() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// Waits while the disk stalls. Returns the error number of the call, or 0.
int meetDisk() {
  if (isThere("stall")) append("stalled", "", 0);
  while (isThere("stall")) usleep(1000);
  return isThere("full") ? ENOSPC : isThere("read-only") ? EROFS : 0;
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (!isRound(file)) return real(file, bytes, size);
  if (const int error = meetDisk(); error != 0) {
    errno = error;
    return -1;
  }
  return real(file, bytes, size);
}

int fdatasync(int file) {
  static const auto real = next<int (*)(int)>("fdatasync");
  if (!isRound(file)) return real(file);
  naiad::SyncNote note;
  note.began = nanos();
  struct stat facts {};
  fstat(file, &facts);
  note.size = facts.st_size;
  meetDisk();
  const int result = real(file);
  note.ended = nanos();
  append("syncs", &note, sizeof note);
  return result;
}

static int openAs(const char* name, const char* path, int flags, mode_t mode) {
  const auto real = next<int (*)(const char*, int, ...)>(name);
  if ((flags & O_CREAT) != 0 && isRound(path)) {
    if (const int error = meetDisk(); error == EROFS) {
      errno = error;
      return -1;
    }
  }
  return real(path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return openAs("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return openAs("open64", path, flags, mode);
}
}
