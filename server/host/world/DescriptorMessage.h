// A message that takes descriptors to another process (SCM_RIGHTS, unix(7)).
//
// No memory is allocated for it: it comes to games, whose heaps have to be the same when they are executed
// again.
#pragma once

#include <cstddef>
#include <span>

namespace naiad {

/// Descriptors of one message at most.
inline constexpr std::size_t kMaxPassed = 8;

/// Send these bytes through a local socket, and copies of 1 to kMaxPassed descriptors with them. `flags`: of
/// sendmsg(2), beside MSG_NOSIGNAL. False: nothing was sent, or not all; errno says why.
bool sendDescriptors(int socket, const void* p_bytes, std::size_t size, std::span<const int> descriptors,
                     int flags = 0);

/// Receive so many bytes, and the descriptors that come with them, in their order and closed in programs that
/// this process executes. `flags`: of recvmsg(2). Return how many descriptors came; -1, and none is left
/// open: the message is of another length, more came than there is room for, or none can be received.
int receiveDescriptors(int socket, void* p_bytes, std::size_t size, std::span<int> room, int flags = 0);

}  // namespace naiad
