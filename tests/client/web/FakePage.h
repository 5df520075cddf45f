// Plays the part of a browser page, and of the server behind its gateway.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "client/web/WebStreamOpener.h"
#include "naiad.pb.h"

namespace naiad::test {

class FakePage : public PageBridge {
 public:
  struct Stream {
    bool closed = false;
    std::vector<wire::ClientMessage> sent;
  };
  struct Sounded {
    SoundLine sound;
    bool own = false;
  };

  void open(int stream) override {
    streams[stream];
    newest = stream;
  }
  void send(int stream, std::string_view frame) override {
    wire::ClientMessage message;
    message.ParseFromArray(frame.data(), static_cast<int>(frame.size()));
    streams[stream].sent.push_back(message);
  }
  std::size_t unsentBytes(int) override { return unsent; }
  void close(int stream) override { streams[stream].closed = true; }
  void saveToken(std::string_view kept) override { token = kept; }
  void sound(const SoundLine& sound, bool own) override { sounds.push_back({sound, own}); }

  /// Returns the messages sent over the newest stream.
  const std::vector<wire::ClientMessage>& sent() { return streams[newest].sent; }

  std::map<int, Stream> streams;
  int newest = 0;
  std::size_t unsent = 0;
  std::string token;
  std::vector<Sounded> sounds;
};

}  // namespace naiad::test
