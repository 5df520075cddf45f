#include "host/loop/StreamRefusalLog.h"

#include <asio/post.hpp>
#include <chrono>
#include <string>

#include "shared/net/stream/ByteStream.h"

namespace naiad {

namespace {

/// For the log alone: the client has been hung up on.
std::string sentenceOf(StreamRefusal why) {
  switch (why) {
    case StreamRefusal::kBanned:
      return "This address is banned.";
    case StreamRefusal::kTooOften:
      return "Too many connections from this network.";
    case StreamRefusal::kPrefixFull:
      return "Too many unfinished connections from this network.";
    case StreamRefusal::kFull:
      return "Too many unfinished connections.";
  }
  return "";
}

}  // namespace

void StreamRefusalLog::note(const asio::ip::tcp::endpoint& peer, StreamRefusal why) {
  const auto now = std::chrono::steady_clock::now();
  if (!m_allowance.takeToken(ClientLog::kRefusalsInAll, now)) return;
  asio::post(m_home, [this, now, address = peerName(peer), sentence = sentenceOf(why)] {
    m_log.logRefusal(address, sentence, now);
  });
}

}  // namespace naiad
