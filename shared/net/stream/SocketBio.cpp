#include "shared/net/stream/SocketBio.h"

#include <openssl/bio.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace naiad {
namespace {

constexpr std::uint8_t kHandshakeRecord = 22;

SocketBio& stateOf(BIO* bio) {
  return *static_cast<SocketBio*>(BIO_get_data(bio));
}

bool mayTryAgain(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

int readSocket(BIO* bio, char* into, int size) {
  SocketBio& state = stateOf(bio);
  BIO_clear_retry_flags(bio);
  const ssize_t got = ::recv(state.socket, into, static_cast<std::size_t>(size), 0);
  if (got > 0) {
    if (!state.guard || state.guard->accept({into, static_cast<std::size_t>(got)}))
      return static_cast<int>(got);
    state.refused = true;
    return -1;
  }
  if (got == 0) {
    state.ended = true;
    return 0;
  }
  if (mayTryAgain(errno)) {
    BIO_set_retry_read(bio);
  } else {
    state.failed = true;
  }
  return -1;
}

int writeSocket(BIO* bio, const char* bytes, int size) {
  SocketBio& state = stateOf(bio);
  BIO_clear_retry_flags(bio);
  const ssize_t sent = ::send(state.socket, bytes, static_cast<std::size_t>(size), MSG_NOSIGNAL);
  if (sent >= 0) return static_cast<int>(sent);
  if (mayTryAgain(errno)) {
    BIO_set_retry_write(bio);
  } else {
    state.failed = true;
  }
  return -1;
}

long control(BIO* bio, int command, long, void*) {
  if (command == BIO_CTRL_FLUSH) return 1;
  if (command == BIO_CTRL_EOF) return stateOf(bio).ended ? 1 : 0;
  return 0;
}

/// Returns the BIO's functions. Created once and never freed, like OpenSSL's own methods.
const BIO_METHOD* method() {
  static const BIO_METHOD* const made = [] {
    BIO_METHOD* fresh = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "naiad socket");
    BIO_meth_set_read(fresh, readSocket);
    BIO_meth_set_write(fresh, writeSocket);
    BIO_meth_set_ctrl(fresh, control);
    return fresh;
  }();
  return made;
}

}  // namespace

bool ClientHelloGuard::accept(std::string_view bytes) {
  while (!bytes.empty()) {
    if (record_left_ == 0) {
      record_header_[record_header_size_++] = static_cast<std::uint8_t>(bytes.front());
      bytes.remove_prefix(1);
      if (record_header_size_ < record_header_.size()) continue;
      record_header_size_ = 0;
      record_left_ = std::size_t{record_header_[3]} << 8 | record_header_[4];
      continue;
    }
    const std::string_view part = bytes.substr(0, std::min(record_left_, bytes.size()));
    if (record_header_[0] == kHandshakeRecord && !acceptMessages(part)) return false;
    record_left_ -= part.size();
    bytes.remove_prefix(part.size());
  }
  return true;
}

bool ClientHelloGuard::acceptMessages(std::string_view bytes) {
  while (!bytes.empty()) {
    if (message_left_ > 0) {
      const std::size_t part = std::min(message_left_, bytes.size());
      message_left_ -= part;
      bytes.remove_prefix(part);
      continue;
    }
    message_header_[message_header_size_++] = static_cast<std::uint8_t>(bytes.front());
    bytes.remove_prefix(1);
    if (message_header_size_ < message_header_.size()) continue;
    message_header_size_ = 0;
    message_left_ =
        std::size_t{message_header_[1]} << 16 | std::size_t{message_header_[2]} << 8 | message_header_[3];
    if (message_left_ > kMaxHello) return false;
  }
  return true;
}

bio_st* SocketBio::make() {
  BIO* const bio = BIO_new(method());
  if (!bio) return nullptr;
  BIO_set_data(bio, this);
  BIO_set_init(bio, 1);
  return bio;
}

}  // namespace naiad
