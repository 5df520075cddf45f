#include "host/rounds/RoomJournals.h"

#include <sys/stat.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "host/rounds/Worlds.h"
#include "host/settings/GameModule.h"
#include "host/settings/RoomList.h"

namespace naiad {

namespace {

/// Lines say which room they are about.
LogLine lineOfRoom(const LogLine& log, const std::string& room) {
  return [log, room](LogEvent event) {
    event.text.insert(0, "room " + room + ": ");
    event.fields.emplace_back("room", room);
    log(event);
  };
}

}  // namespace

std::vector<std::shared_ptr<Journals>> openRoomJournals(const HostOptions& options, std::uint16_t port,
                                                        const std::vector<LaunchedRoom>& rooms,
                                                        const LogLine& log) {
  std::vector<std::shared_ptr<Journals>> journals(rooms.size());
  if (!wantsJournal(options)) return journals;
  if (::mkdir(options.journal.c_str(), 0700) != 0 && errno != EEXIST)
    throw std::system_error(errno, std::generic_category(), options.journal);
  const std::vector<RoomOptions> of_rooms = roomsOf(options);
  const HostOptions with_time = withFrameTime(options, rooms.front().plan.ready);
  const auto shared = std::make_shared<SharedJournals>();
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    HostOptions own = optionsOf(with_time, of_rooms[i]);
    own.port = port;
    own.journal += "/" + of_rooms[i].name;
    journals[i] = std::make_shared<Journals>(own, rooms[i].plan.game, GameModule::find(own.game).string(),
                                             lineOfRoom(log, of_rooms[i].name), shared);
  }
  return journals;
}

}  // namespace naiad
