// One test at a time in the port of local networks: it is the same for all servers and clients of a machine,
// so that one test's questions would use up what another one's server may answer.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

namespace naiad::test {

/// Held while it lives, against other processes and other such objects.
class LanLock {
 public:
  LanLock()
      : m_descriptor(::open((std::filesystem::temp_directory_path() / "naiad-lan-test").c_str(),
                            O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    ::flock(m_descriptor, LOCK_EX);
  }
  ~LanLock() { ::close(m_descriptor); }
  LanLock(const LanLock&) = delete;
  LanLock& operator=(const LanLock&) = delete;

 private:
  int m_descriptor;
};

}  // namespace naiad::test
