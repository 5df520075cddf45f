// Messages between a host and a world in its own process. A stranger's game may be at the other end.
//
//   input   0 turn, 1 answers (1) | turn: the fields of its message; answers: each length (2) | fields
//
// The fields of a turn are also read as the game's setup.
#include "Target.h"
#include "engine/world/WorldExtras.h"
#include "host/snapshot/LookCapture.h"
#include "host/snapshot/Publisher.h"
#include "host/world/BuildId.h"
#include "host/world/TurnRecord.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"

namespace naiad::fuzz {
namespace {

std::string_view fieldsOf(const std::string& frame) {
  return std::string_view(frame).substr(kWorldFrameHead);
}

void tryTurn(std::string_view bytes) {
  TurnRecordReader records;
  bool copied = false;
  const auto turn = readTurnMessage(bytes, records, copied);
  if (!turn) return;
  std::string record;
  std::string message;
  std::string again;
  REQUIRE(TurnRecordWriter().write(*turn, record));
  appendTurnMessage(record, copied, message);
  TurnRecordReader others;
  const auto same = readTurnMessage(fieldsOf(message), others, copied);
  REQUIRE(same && same->inputs.size() == turn->inputs.size());
  REQUIRE(TurnRecordWriter().write(*same, again));
  REQUIRE(again == record);
}

/// Returns the beginning of a message with this build's id, which no input would contain by chance.
std::string ownBegin() {
  std::string frame;
  FieldWriter out(frame);
  out.text(ownBuildId(), kMaxBuildId);
  out.finish();
  return frame.substr(kWorldFrameHead);
}

void tryReady(std::string_view bytes) {
  readBuild(bytes);
  const auto ready = readReady(ownBegin().append(bytes));
  if (!ready) return;
  REQUIRE(ready->window_width >= kMinViewWidth && ready->window_width <= kMaxViewWidth);
  REQUIRE(ready->help.size() <= kMaxHelpLines);
  std::string frame;
  std::string again;
  writeReady(*ready, frame);
  const auto same = readReady(fieldsOf(frame));
  REQUIRE(same);
  writeReady(*same, again);
  REQUIRE(again == frame);
}

/// Reads the answers of one world in order, like a host.
class Host {
 public:
  /// Returns false if the host would end the world.
  bool take(std::string_view bytes) {
    const auto answer = readAnswer(bytes, m_views, m_view);
    if (!answer) return false;
    for (const WorldPicture& picture : answer->pictures)
      REQUIRE(picture.canvas.width() <= kMaxViewWidth && picture.canvas.height() <= kMaxViewHeight);
    if (!answer->has_view) return true;
    check();
    m_publisher.update(m_view);
    m_publisher.forEach([this](std::uint32_t slot, const Publisher::Model& model) {
      REQUIRE(model.state.look.sequence.glyphCount() <= kMaxGlyphs);
      (void)m_publisher.sharedMotion(slot);
    });
    ViewWriter writer;
    ViewReader reader;
    std::string frame;
    df::WorldView same;
    REQUIRE(writeAnswer(*answer, &m_view, writer, frame));
    REQUIRE(readAnswer(fieldsOf(frame), reader, same));
    REQUIRE(same.tick == m_view.tick && same.changed.size() == m_view.changed.size() &&
            same.players.size() == m_view.players.size());
    return true;
  }

 private:
  void check() const {
    REQUIRE(m_view.view_width >= kMinViewWidth && m_view.view_width <= kMaxViewWidth);
    for (const df::DrawCommand& command : m_view.commands)
      REQUIRE(df::isDrawable(command.ch) && command.color >= df::BLACK && command.color <= df::WHITE);
    for (const df::DrawnObject& drawn : m_view.drawn)
      REQUIRE(std::uint64_t{drawn.first} + drawn.count <= m_view.commands.size());
    for (const df::PublishedLook& told : m_view.looks)
      REQUIRE(told.drawn < m_view.drawn.size() && told.p_look->selector.fits(told.p_look->sequence.size()));
    REQUIRE(m_view.notes.size() <= df::WorldExtras::kMaxNotes);
    for (const df::PlayerFacts& player : m_view.players) {
      REQUIRE(player.id != 0);
      for (const df::PlayerText& text : player.texts) REQUIRE(text.id < kMaxTexts);
      REQUIRE(player.steering.p_table == nullptr || isValid(*player.steering.p_table));
    }
  }

  ViewReader m_views{1000};
  df::WorldView m_view;
  Publisher m_publisher;
};

}  // namespace

void tryInput(Script script) {
  if (!script.flag()) {
    const Exactly bytes(script.rest());
    tryTurn(bytes.view());
    tryReady(bytes.view());
    return;
  }
  Host host;
  for (bool goes_on = true; goes_on && !script.atEnd();) {
    const auto length = script.number<std::uint16_t>();
    const Exactly bytes(script.bytes(length));
    goes_on = host.take(bytes.view());
  }
}

}  // namespace naiad::fuzz
