#include "host/rounds/RoomLauncher.h"

#include <sys/stat.h>

#include <cerrno>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "host/rounds/WorldFactory.h"
#include "host/settings/GameModule.h"
#include "host/settings/RoomOptions.h"

namespace naiad {

namespace {

/// Returns a log that names the room in each line.
LogLine lineOfRoom(const LogLine& log, const std::string& room) {
  return [log, room](LogEvent event) {
    event.text.insert(0, "room " + room + ": ");
    event.fields.emplace_back("room", room);
    log(event);
  };
}

/// Worlds' nice value minus the front's: a busy game leaves the front, which serves all rooms, enough time.
constexpr int kNice = 5;

/// Returns the key of a room's launcher. Rooms that differ only in name and number of players share it.
std::string kindOf(const RoomOptions& room) {
  return room.game + " " + std::to_string(room.world_memory) + " " + std::to_string(room.seed) + " " +
         room.players;
}

/// Returns a log that drops repeated lines, which several launchers write.
LogLine onceOnly(const LogLine& log) {
  return [log, said = std::make_shared<std::set<std::string>>()](const LogEvent& event) {
    if (said->insert(event.text).second) log(event);
  };
}

WorldReady preview(const RoomOptions& room, const WorldLauncher& launcher, const LogLine& print) {
  GameProbe seen = probeGame(launcher, print);
  if (seen.ready) return *std::move(seen.ready);
  throw GameError("--room " + room.name + ": the game " + seen.end.text +
                  (seen.end.when.empty() ? " before GM.run()" : " " + seen.end.when));
}

void warnOfTicks(const std::vector<LaunchedRoom>& rooms, const HostOptions& options, const LogLine& log) {
  if (options.frame_micros != 0) return;
  for (const LaunchedRoom& room : rooms) {
    const int wanted = room.plan.ready.frame_millis;
    const int given = rooms.front().plan.ready.frame_millis;
    if (wanted == given) continue;
    log({LogEvent::Level::kWarning, "warning: the game in room " + room.plan.name + " asks for ticks of " +
                                        std::to_string(wanted) + " ms; this server uses " +
                                        std::to_string(given) + " ms, as its first room does"});
  }
}

}  // namespace

std::vector<std::shared_ptr<RoundJournals>> openRoomJournals(const HostOptions& options, std::uint16_t port,
                                                             const std::vector<LaunchedRoom>& rooms,
                                                             const LogLine& log) {
  std::vector<std::shared_ptr<RoundJournals>> journals(rooms.size());
  if (!usesJournal(options)) return journals;
  if (::mkdir(options.journal.c_str(), 0700) != 0 && errno != EEXIST)
    throw std::system_error(errno, std::generic_category(), options.journal);
  const std::vector<RoomOptions> of_rooms = parseRooms(options);
  const HostOptions with_time = withFrameTime(options, rooms.front().plan.ready);
  const auto shared = std::make_shared<SharedJournals>();
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    HostOptions own = optionsOf(with_time, of_rooms[i]);
    own.port = port;
    own.journal += "/" + of_rooms[i].name;
    journals[i] =
        std::make_shared<RoundJournals>(own, rooms[i].plan.game, GameModule::find(own.game).string(),
                                        lineOfRoom(log, of_rooms[i].name), shared);
  }
  return journals;
}

std::vector<LaunchedRoom> launchRooms(const HostOptions& options, const std::string& config,
                                      const LogLine& log,
                                      const std::function<LogLine(const std::string& room)>& print) {
  const std::vector<RoomOptions> rooms = parseRooms(options);
  const LogLine log_once = onceOnly(log);
  std::map<std::string, std::shared_ptr<const WorldLauncher>> launchers;
  for (const RoomOptions& room : rooms) {
    auto& launcher = launchers[kindOf(room)];
    if (launcher != nullptr) continue;
    launcher =
        launchModule(optionsOf(options, room), GameModule::find(room.game).string(), config, log_once, kNice);
  }
  std::map<std::string, WorldReady> seen;
  std::vector<LaunchedRoom> launched;
  for (const RoomOptions& room : rooms) {
    const std::string kind = kindOf(room);
    if (!seen.contains(kind)) seen[kind] = preview(room, *launchers[kind], print(room.name));
    launched.push_back({{.name = room.name,
                         .game = GameModule::nameOf(GameModule::find(room.game)),
                         .max_players = room.max_players,
                         .first_only = room.players == "first",
                         .ready = seen[kind],
                         .new_world = {}},
                        launchers[kind]});
  }
  warnOfTicks(launched, options, log);
  return launched;
}

}  // namespace naiad
