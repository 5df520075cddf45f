#include "host/world/DescriptorMessage.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>

namespace naiad {

namespace {

constexpr std::size_t kRightsSize = kMaxPassed * sizeof(int);

using RightsRoom = std::array<char, CMSG_SPACE(kRightsSize)>;

/// Collects all descriptors of a message, expected or not.
std::size_t extractRights(msghdr& message, std::array<int, kMaxPassed>& found) {
  std::size_t count = 0;
  for (cmsghdr* p = CMSG_FIRSTHDR(&message); p != nullptr; p = CMSG_NXTHDR(&message, p)) {
    if (p->cmsg_level != SOL_SOCKET || p->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t here = std::min((p->cmsg_len - CMSG_LEN(0)) / sizeof(int), found.size() - count);
    std::memcpy(found.data() + count, CMSG_DATA(p), here * sizeof(int));
    count += here;
  }
  return count;
}

}  // namespace

bool sendDescriptors(int socket, const void* p_bytes, std::size_t size, std::span<const int> descriptors,
                     int flags) {
  assert(!descriptors.empty() && descriptors.size() <= kMaxPassed);
  iovec data{const_cast<void*>(p_bytes), size};  // sendmsg() only reads it
  alignas(cmsghdr) RightsRoom rights{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = rights.data();
  message.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
  cmsghdr* p_head = CMSG_FIRSTHDR(&message);
  p_head->cmsg_level = SOL_SOCKET;
  p_head->cmsg_type = SCM_RIGHTS;
  p_head->cmsg_len = CMSG_LEN(descriptors.size_bytes());
  std::memcpy(CMSG_DATA(p_head), descriptors.data(), descriptors.size_bytes());
  ssize_t sent = 0;
  while ((sent = sendmsg(socket, &message, MSG_NOSIGNAL | flags)) < 0 && errno == EINTR) continue;
  return sent == static_cast<ssize_t>(size);
}

// The kernel closes descriptors that do not fit into the message's buffer, and sets MSG_CTRUNC.
int receiveDescriptors(int socket, void* p_bytes, std::size_t size, std::span<int> room, int flags) {
  iovec data{p_bytes, size};
  alignas(cmsghdr) RightsRoom rights{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = rights.data();
  message.msg_controllen = rights.size();
  ssize_t got = 0;
  while ((got = recvmsg(socket, &message, MSG_CMSG_CLOEXEC | flags)) < 0 && errno == EINTR) continue;
  if (got < 0) return -1;
  std::array<int, kMaxPassed> found{};
  const std::size_t count = extractRights(message, found);
  const bool is_whole =
      got == static_cast<ssize_t>(size) && (message.msg_flags & (MSG_CTRUNC | MSG_TRUNC)) == 0;
  if (is_whole && count <= room.size()) {
    std::copy_n(found.begin(), count, room.begin());
    return static_cast<int>(count);
  }
  for (std::size_t i = 0; i < count; ++i) close(found[i]);
  return -1;
}

}  // namespace naiad
