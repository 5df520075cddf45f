// A server for commands without one: notes what is done to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/admin/AdminTarget.h"

namespace naiad::test {

class FakeTarget : public AdminTarget {
 public:
  std::vector<AdminPlayer> all;
  std::vector<std::string> done;  ///< in order
  std::vector<AdminRow> named_rooms;
  std::optional<PasswordHash> password;

  AdminPlayer& add(const std::string& name, const std::string& address = "192.0.2.1:50000") {
    const auto number = static_cast<std::uint32_t>(all.size()) + 1;
    AdminPlayer player;
    player.session = 100 + number;
    player.id = number;
    player.name = name;
    player.address = address;
    return all.emplace_back(player);
  }
  bool has(const std::string& name) const {
    return std::any_of(all.begin(), all.end(), [&name](const auto& one) { return one.name == name; });
  }

  std::vector<AdminPlayer> players() const override { return all; }
  AdminRow status() const override { return {{"players", static_cast<std::int64_t>(all.size())}}; }
  void endPlayer(std::uint64_t session, const std::string& sentence) override {
    for (const AdminPlayer& player : all) {
      if (player.session == session) done.push_back("end " + player.name + ": " + sentence);
    }
    std::erase_if(all, [session](const AdminPlayer& player) { return player.session == session; });
  }
  void say(const std::string& text) override { done.push_back("say: " + text); }
  void tell(std::uint64_t session, const std::string& text) override {
    done.push_back("tell " + std::to_string(session) + ": " + text);
  }
  void setMuted(std::uint64_t session, bool muted) override {
    for (AdminPlayer& player : all) {
      if (player.session == session) player.muted = muted;
    }
  }
  AdminAnswer stop(const std::string& sentence) override { return note("stop: " + sentence); }
  AdminAnswer restart(const AdminRestart& restart) override {
    return note("restart " + std::to_string(static_cast<int>(restart.when)) + " " +
                std::to_string(restart.in.count()));
  }
  void keepRound(std::function<void(AdminAnswer)> done_trying) override { done_trying(note("keep")); }
  AdminAnswer drain(std::optional<std::chrono::seconds> most) override {
    return note("drain " + (most ? std::to_string(most->count()) : "as usual"));
  }
  AdminAnswer cancel() override { return note("cancel"); }
  void reload(std::function<void(AdminAnswer)> done_reading) override { done_reading(note("reload")); }
  AdminAnswer changePassword(std::optional<PasswordHash> hash) override {
    password = std::move(hash);
    return note("password");
  }
  void scores(const AdminScores& which, std::function<void(AdminAnswer)> read) override {
    read(note("scores " + which.table + " " + std::to_string(which.count) +
              (which.room.empty() ? "" : " room " + which.room) +
              (which.game.empty() ? "" : " game " + which.game)));
  }
  AdminAnswer set(const std::string& option, const std::string& value) override {
    return note("set " + option + "=" + value);
  }
  std::vector<AdminRow> rooms() const override { return named_rooms; }
  AdminRow settings() const override { return {{"grace", std::string("60")}}; }

 private:
  AdminAnswer note(std::string what) {
    done.push_back(what);
    return AdminAnswer::done(std::move(what));
  }
};

}  // namespace naiad::test
