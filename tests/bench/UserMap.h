// User and group ids in a user namespace.
#pragma once

#include <sys/types.h>

#include <string>

namespace bench {

/// Maps `user` and `group` in a new user namespace to their ids outside, so that files keep their owner.
/// False if the system refuses.
bool mapUser(uid_t user, gid_t group);

/// Writes the text to an existing file. False unless all was written.
bool writeText(const std::string& file, const std::string& text);

}  // namespace bench
