// User and group ids in a user namespace.
#pragma once

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <string>

namespace bench {

/// Writes the text to an existing file. False if a part of it was not written.
inline bool writeText(const std::string& file, const std::string& text) {
  const int fd = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool written = write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(fd);
  return written;
}

/// Call in a new user namespace. Gives `user` and `group` equal ids inside and outside, so that files keep
/// their owner. False if the system refuses.
inline bool mapUser(uid_t user, gid_t group) {
  const std::string user_text = std::to_string(user);
  const std::string group_text = std::to_string(group);
  return writeText("/proc/self/setgroups", "deny") &&
         writeText("/proc/self/uid_map", user_text + " " + user_text + " 1") &&
         writeText("/proc/self/gid_map", group_text + " " + group_text + " 1");
}

}  // namespace bench
