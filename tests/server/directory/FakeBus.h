// A fake bus: records published messages, delivers messages of the test, and is connected or not, as the test
// chooses.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/fleet/Bus.h"

namespace naiad::test {

class FakeBus : public Bus {
 public:
  void publish(BusMessage message) override { published.push_back(std::move(message)); }
  bool isConnected() const override { return connected; }
  std::vector<BusMessage> popMessages() override { return std::exchange(heard, {}); }
  void finish(std::chrono::milliseconds /*patience*/) override {}
  BusCounters counters() const override { return {.lost = lost}; }
  std::string popLogMessage() override { return std::exchange(news, ""); }

  std::vector<BusMessage> published;
  std::vector<BusMessage> heard;
  std::string news;
  bool connected = true;
  std::uint64_t lost = 0;
};

}  // namespace naiad::test
