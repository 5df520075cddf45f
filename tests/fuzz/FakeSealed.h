// A datagram channel without a network: the fuzz target acts as the other end.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "host/net/SealedChannel.h"
#include "shared/net/base/Channel.h"
#include "shared/replica/Limits.h"

namespace naiad::fuzz {

/// The source of the channel's packets. Must outlive the channel.
struct FakeAir {
  std::function<void(std::string_view packet)> on_packet;
};

class FakeSealed : public SealedChannel {
 public:
  explicit FakeSealed(FakeAir& air) : m_air(air) {}
  ~FakeSealed() override { m_air.on_packet = nullptr; }
  void start(std::function<void(std::string_view packet)> on_packet) override {
    m_air.on_packet = std::move(on_packet);
  }
  void send(std::string_view) override {}
  std::optional<std::size_t> payloadBudget() const override { return kMaxDatagramSnapshot; }
  std::string peerAddress() const override { return "fake:1"; }
  std::uint64_t id() const override { return 1; }
  AeadId aead() const override { return AeadId::kAes128Gcm; }
  Epoch epoch() const override { return 1; }
  bool renew(const ReliableChannel&, Epoch) override { return true; }

 private:
  FakeAir& m_air;
};

}  // namespace naiad::fuzz
