#include "host/admin/PlayerChoice.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>

namespace naiad {

namespace {

using Fits = std::function<bool(const AdminPlayer&)>;

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::optional<std::uint32_t> idOf(const std::string& typed) {
  if (typed.size() < 2 || typed.front() != '#') return std::nullopt;
  std::uint32_t id = 0;
  const char* const p_end = typed.data() + typed.size();
  const auto [p_read, error] = std::from_chars(typed.data() + 1, p_end, id);
  return error == std::errc() && p_read == p_end ? std::optional(id) : std::nullopt;
}

std::vector<AdminPlayer> thoseThat(const std::vector<AdminPlayer>& players, const Fits& fits) {
  std::vector<AdminPlayer> found;
  std::copy_if(players.begin(), players.end(), std::back_inserter(found), fits);
  return found;
}

PlayerChoice oneOf(const std::vector<AdminPlayer>& found, const std::string& typed) {
  if (found.size() == 1) return {found.front()};
  AdminAnswer problem = AdminAnswer::refused("Several players may be meant by \"" + typed + "\":");
  for (const AdminPlayer& player : found)
    problem.candidates.push_back("#" + std::to_string(player.id) + " " + player.name);
  return {std::nullopt, std::move(problem)};
}

}  // namespace

PlayerChoice choosePlayer(const std::vector<AdminPlayer>& players, const std::string& typed) {
  std::vector<Fits> ways;
  if (const auto id = idOf(typed)) {
    ways = {[id](const AdminPlayer& player) { return player.id == *id; }};
  } else {
    const std::string low = lowered(typed);
    ways = {[&typed](const AdminPlayer& player) { return player.name == typed; },
            [low](const AdminPlayer& player) { return lowered(player.name) == low; },
            [low](const AdminPlayer& player) { return lowered(player.name).starts_with(low); }};
  }
  for (const Fits& fits : ways) {
    const std::vector<AdminPlayer> found = thoseThat(players, fits);
    if (!found.empty()) return oneOf(found, typed);
  }
  return {std::nullopt, AdminAnswer::refused("There is no player \"" + typed + "\".")};
}

}  // namespace naiad
