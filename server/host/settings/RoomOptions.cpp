#include "host/settings/RoomOptions.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "host/settings/GameModule.h"
#include "shared/net/base/SafeText.h"
#include "shared/options/Options.h"

namespace naiad {

namespace {

constexpr std::size_t kMaxShown = 80;  ///< maximum characters of the user's text quoted in a message

std::string asTyped(const std::string& text) {
  return "\"" + safeText(text, kMaxShown) + "\"";
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

/// Returns the settings that a room may have. They are named like the server's options.
std::vector<Option> settingsOf(RoomOptions& room) {
  return {{"--max-players", &room.max_players, "", "", OptionRange{1, kMaxServerPlayers}},
          {"--world-memory", &room.world_memory, "", "", OptionRange{0, 1 << 20}},
          {"--seed", &room.seed, "", "", OptionRange{0, 9e15}},
          {"--input-mode", &room.players, "", "", {}, {"together", "first"}}};
}

std::vector<std::string> settingNames() {
  RoomOptions room;
  std::vector<std::string> names;
  for (const Option& option : settingsOf(room)) names.push_back(option.name.substr(2));
  return names;
}

/// Stores a setting KEY=VALUE. Throws OptionError, whose text begins with `place`.
void storeSetting(RoomOptions& room, const std::string& text, const std::string& place) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  for (const Option& option : settingsOf(room)) {
    if (option.name != "--" + key && formerNameOf(option.name) != "--" + key) continue;
    const std::string setting = std::string(place).append(": ").append(key);
    if (equals == std::string::npos) throw OptionError(setting + ": expected KEY=VALUE");
    return storeValue(option, text.substr(equals + 1), setting);
  }
  throw OptionError(place + ": unknown room setting " + asTyped(key) + suggestion(key, settingNames()));
}

/// Parses NAME=GAME[,KEY=VALUE…]. Throws OptionError.
RoomOptions readRoom(const std::string& text, const HostOptions& options) {
  const std::vector<std::string> parts = split(text, ',');
  const std::size_t equals = parts.empty() ? std::string::npos : parts.front().find('=');
  if (equals == std::string::npos)
    throw OptionError("--room " + asTyped(text) + ": expected NAME=GAME or NAME=GAME,KEY=VALUE");
  RoomOptions room{.name = parts.front().substr(0, equals),
                   .game = parts.front().substr(equals + 1),
                   .max_players = options.max_players,
                   .world_memory = options.world_memory,
                   .seed = options.seed,
                   .players = options.players};
  if (!isRoomName(room.name))
    throw OptionError("--room: invalid room name " + asTyped(room.name) + ": " + kRoomNameRule);
  const std::string place = "--room " + room.name;
  if (room.game.empty()) throw OptionError(place + ": expected a game after the =");
  for (std::size_t i = 1; i < parts.size(); ++i) storeSetting(room, parts[i], place);
  return room;
}

std::vector<RoomOptions> readRooms(const HostOptions& options) {
  std::vector<RoomOptions> rooms;
  std::istringstream words(options.rooms);
  for (std::string word; words >> word;) rooms.push_back(readRoom(word, options));
  return rooms;
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
  return text;
}

/// Returns a message if the room's game is missing. Checked at the start, before a player wakes the room.
std::string gameComplaint(const RoomOptions& room) {
  try {
    const auto module = GameModule::find(room.game);
    std::error_code error;
    if (std::filesystem::is_regular_file(module, error)) return {};
    return "--room " + room.name + ": no such file: " + asTyped(module.string());
  } catch (const GameError&) {
    const std::vector<std::string> games = GameModule::available();
    const std::string near = suggestion(room.game, games);
    return "--room " + room.name + ": unknown game " + asTyped(room.game) +
           (near.empty() ? "; --list-games prints the known ones" : near);
  }
}

/// Returns a message about an option that contradicts --room; else empty.
std::string conflict(const HostOptions& options) {
  if (options.players == "private") return "--room cannot be used with --input-mode private";
  if (options.on_game_over == "exit") return "--room cannot be used with --on-game-over exit";
  if (!options.truth_file.empty()) return "--room cannot be used with --truth-file";
  return {};
}

}  // namespace

std::vector<RoomOptions> parseRooms(const HostOptions& options) {
  return readRooms(options);
}

std::string validateRoomOptions(const HostOptions& options) {
  if (options.rooms.empty()) return {};
  std::vector<RoomOptions> rooms;
  try {
    rooms = readRooms(options);
  } catch (const OptionError& error) {
    return error.what();
  }
  if (rooms.size() > kMaxRooms)
    return "--room: at most " + std::to_string(kMaxRooms) + " rooms are possible, not " +
           std::to_string(rooms.size());
  std::set<std::string> names;
  for (const RoomOptions& room : rooms) {
    // Players would confuse names that differ only in case.
    if (!names.insert(lowerCase(room.name)).second)
      return "--room " + room.name + ": this name is used twice";
    if (std::string wrong = gameComplaint(room); !wrong.empty()) return wrong;
  }
  return conflict(options);
}

void useRooms(HostOptions& options) {
  const std::vector<RoomOptions> rooms = parseRooms(options);
  if (rooms.empty()) return;
  options.game = rooms.front().game;
  options.on_game_over = "restart";
}

HostOptions optionsOf(const HostOptions& options, const RoomOptions& room) {
  HostOptions own = options;
  own.rooms.clear();
  own.game = room.game;
  own.max_players = room.max_players;
  own.world_memory = room.world_memory;
  own.seed = room.seed;
  own.players = room.players;
  own.on_game_over = "restart";
  return own;
}

std::string unknownRoomMessage(const std::string& typed, const std::vector<std::string>& names) {
  const std::string near = nearestName(typed, names);
  std::string sentence = "There is no room " + asTyped(typed);
  if (!near.empty()) return sentence + "; did you mean \"" + near + "\"?";
  sentence += ". Rooms: ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (sentence.size() > kMaxMessageLength / 2) return sentence + ", …";
    sentence += (i > 0 ? ", " : "") + names[i];
  }
  return sentence + ".";
}

}  // namespace naiad
