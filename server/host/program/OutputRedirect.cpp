#include "host/program/OutputRedirect.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

namespace naiad {

namespace {

// What the game has printed so far belongs where it was when it printed it.
void flushAll() {
  std::cout.flush();
  std::clog.flush();
  std::fflush(stdout);
}

// A pipe whose other end is not read would hold up the game.
int openOrNull(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0640);
  struct stat facts {};
  if (file >= 0 && fstat(file, &facts) == 0 && S_ISREG(facts.st_mode)) return file;
  if (file >= 0) ::close(file);
  return ::open("/dev/null", O_WRONLY | O_CLOEXEC);
}

}  // namespace

OutputRedirect::OutputRedirect(const std::string& path) {
  flushAll();
  const bool errors_too = isatty(STDERR_FILENO) == 1;
  for (int n = 0; n < 3; ++n) {
    m_saved[n] = fcntl(n, F_DUPFD_CLOEXEC, 3);
    if (m_saved[n] >= 0 || (n == STDERR_FILENO && !errors_too)) continue;
    const int problem = errno;
    for (const int saved : m_saved) {
      if (saved >= 0) close(saved);
    }
    throw std::system_error(problem, std::generic_category(), "no descriptors for the terminal");
  }
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int file = openOrNull(path);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  if (file >= 0) dup2(file, STDOUT_FILENO);
  if (file >= 0 && errors_too) dup2(file, STDERR_FILENO);
  if (nothing >= 0) close(nothing);
  if (file >= 0) close(file);
}

OutputRedirect::~OutputRedirect() {
  flushAll();
  for (int n = 0; n < 3; ++n) {
    if (m_saved[n] < 0) continue;
    dup2(m_saved[n], n);
    close(m_saved[n]);
  }
}

}  // namespace naiad
