// What a user may be in a user namespace of their own.
#pragma once

#include <sys/types.h>

#include <string>

namespace bench {

/// In a new user namespace `user` and `group` are what they were outside, so that files keep their owner.
/// False if the system refuses it.
bool mapUser(uid_t user, gid_t group);

/// False unless the whole text was written to the file, which exists.
bool writeText(const std::string& file, const std::string& text);

}  // namespace bench
