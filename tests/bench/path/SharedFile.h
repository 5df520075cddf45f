// A file that contains a T and that several processes map into memory. The programs of this folder use it to
// observe each other.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace bench::path {

/// T must consist of plain data and lock-free atomics. create() and open() throw std::runtime_error on
/// failure.
template <class T>
class SharedFile {
 public:
  /// Creates the file with a new T in it.
  static SharedFile create(const std::string& name) {
    SharedFile file(name, O_RDWR | O_CREAT | O_TRUNC);
    new (file.m_p_value) T;
    return file;
  }
  /// Opens an existing file.
  static SharedFile open(const std::string& name) { return SharedFile(name, O_RDWR); }

  SharedFile(SharedFile&& other) noexcept : m_p_value(std::exchange(other.m_p_value, nullptr)) {}
  SharedFile& operator=(SharedFile&&) = delete;
  ~SharedFile() {
    if (m_p_value != nullptr) munmap(m_p_value, sizeof(T));
  }

  T& operator*() const { return *m_p_value; }
  T* operator->() const { return m_p_value; }

 private:
  SharedFile(const std::string& name, int flags) {
    const int fd = ::open(name.c_str(), flags | O_CLOEXEC, 0600);
    if (fd < 0) throw std::runtime_error(name + " cannot be opened");
    struct stat status {};
    if ((flags & O_CREAT) != 0 && ftruncate(fd, sizeof(T)) != 0) {
      close(fd);
      throw std::runtime_error(name + " cannot be written");
    }
    if (fstat(fd, &status) != 0 || status.st_size != static_cast<off_t>(sizeof(T))) {
      close(fd);
      throw std::runtime_error(name + " is of another kind");
    }
    void* p_map = mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (p_map == MAP_FAILED) throw std::runtime_error(name + " cannot be mapped");
    m_p_value = static_cast<T*>(p_map);
  }

  T* m_p_value = nullptr;
};

}  // namespace bench::path
