// Fake players for tests of commands, without a server.
#pragma once

#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"

namespace naiad::test {

struct Players {
  std::vector<AdminPlayer> all;

  AdminPlayer& add(const std::string& name, const std::string& address = "192.0.2.1:50000") {
    const auto number = static_cast<std::uint32_t>(all.size()) + 1;
    all.push_back({.session = 100 + number, .id = number, .name = name, .address = address, .room = {}});
    return all.back();
  }
};

}  // namespace naiad::test
