// Messages that pass descriptors to another process (SCM_RIGHTS, unix(7)).
//
// The functions allocate no memory: games' processes call them, and a game's heap must be equal in a replay.
#pragma once

#include <cstddef>
#include <span>

namespace naiad {

/// Maximum descriptors of one message.
inline constexpr std::size_t kMaxPassed = 8;

/// Sends these bytes through a local socket, with copies of 1 to kMaxPassed descriptors. `flags`: for
/// sendmsg(2); MSG_NOSIGNAL is added. Returns false if not all was sent; after an error, errno says why.
bool sendDescriptors(int socket, const void* p_bytes, std::size_t size, std::span<const int> descriptors,
                     int flags = 0);

/// Receives `size` bytes and the descriptors that come with them, in their order and with close-on-exec.
/// `flags`: for recvmsg(2). Returns the number of descriptors; -1, with none left open, if the message has
/// another length, has more descriptors than fit in `room`, or cannot be received.
int receiveDescriptors(int socket, void* p_bytes, std::size_t size, std::span<int> room, int flags = 0);

}  // namespace naiad
