// User and group ids in a user namespace.
#pragma once

#include <sys/types.h>

#include <string>

namespace bench {

/// Call in a new user namespace. Gives `user` and `group` equal ids inside and outside, so that files keep
/// their owner. False if the system refuses.
bool mapUser(uid_t user, gid_t group);

/// Writes the text to an existing file. False if a part of it was not written.
bool writeText(const std::string& file, const std::string& text);

}  // namespace bench
