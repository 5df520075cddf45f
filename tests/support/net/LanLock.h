// Lets only one test at a time use the LAN discovery port. All servers and clients of a machine share it, so
// one test's queries would use up the answers that another test's server may send.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>

namespace naiad::test {

/// Holds the lock for its lifetime, also against other processes.
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
