#include "host/world/TurnRecord.h"

#include <utility>

#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"

namespace naiad {

namespace {

enum RecordKind : std::uint8_t {
  kRecordedTurn = 0,     ///< a turn with the flags of the previous turn
  kRecordedNewTurn = 1,  ///< a turn with its flags, which may differ from the previous turn's
  kRecordedResult = 2,
  kRecordedPicture = 3,
  kRecordedSession = 4,
  kRecordedDrop = 5,
};

template <class F, class T>
void visitSeen(F& f, T& seen) {
  f.flag(seen.known);
  f.number(seen.base);
  f.number(seen.drawn);
}

template <class F, class T>
void visitRoom(F& f, T& room) {
  f.text(room.name, df::GameRoomLimits::kMaxName);
  f.text(room.game, df::GameRoomLimits::kMaxGame);
  f.number(room.players, 0, df::GameRoomLimits::kMaxPlayers);
  f.number(room.max_players, 0, df::GameRoomLimits::kMaxPlayers);
  f.flag(room.is_asleep);
  f.flag(room.is_this_one);
}

template <class F, class T>
void visitInput(F& f, T& input) {
  f.number(input.kind, df::InputQueue::kJoin, df::InputQueue::kRoom);
  f.number(input.player);
  switch (input.kind) {
    case df::InputQueue::kJoin:
      f.text(input.name, kMaxNameBytes);
      return f.number(input.color, df::BLACK, df::WHITE);
    case df::InputQueue::kLeave:
      return;
    case df::InputQueue::kKey:
      f.number(input.key, 0, df::Keyboard::kKeyCount - 1);
      return f.number(input.key_action, df::KEY_PRESSED, df::KEY_DOWN);
    case df::InputQueue::kMouse:
      f.number(input.mouse_action, df::CLICKED, df::MOVED);
      f.number(input.button, df::Mouse::UNDEFINED_MOUSE_BUTTON, df::Mouse::MIDDLE);
      f.number(input.x, 0, kMaxViewWidth - 1);
      f.number(input.y, 0, kMaxViewHeight - 1);
      return visitSeen(f, input.seen);
    case df::InputQueue::kScore:
      return visitScore(f, input.table, input.name, input.points);
    case df::InputQueue::kRoom:
      return visitRoom(f, input.room);
  }
}

template <class F, class T>
void visitHead(F& f, T& turn) {
  f.flag(turn.watched);
  f.flag(turn.wants_truth);
  f.flag(turn.ends_game);
  f.flag(turn.checked);
  f.number(turn.input_player);
  f.number(turn.rendered_player);
}

template <class F, class T>
void visitInputs(F& f, T& inputs) {
  f.list(inputs, kMaxTurnInputs, [](F& in, auto& input) { visitInput(in, input); });
}

template <class F, class T>
void visitResult(F& f, T& result) {
  f.flag(result.has_check);
  f.flag(result.game_over);
  bool has_state = result.state_hash.has_value();
  f.flag(has_state);
  if (result.has_check) f.number(result.check, 0, 255);
  if (!has_state) return;
  const std::uint64_t hash = result.state_hash.value_or(0);
  auto low = static_cast<std::uint32_t>(hash);
  auto high = static_cast<std::uint32_t>(hash >> 32);
  f.number(low);
  f.number(high);
  if constexpr (F::kReads) result.state_hash = std::uint64_t{high} << 32 | low;
}

template <class F, class T>
void visitSession(F& f, T& session) {
  f.number(session.player);
  f.flag(session.over);
  if (session.over) return;
  f.flag(session.muted);
  f.text(session.name, kMaxPersistedName);
  f.number(session.color, df::BLACK, df::WHITE);
  for (auto* p_hash : {&session.newest, &session.redeemed}) f.text(*p_hash, kPersistedHashSize);
}

bool hasSameHead(const WorldTurn& a, const WorldTurn& b) {
  return a.watched == b.watched && a.wants_truth == b.wants_truth && a.ends_game == b.ends_game &&
         a.checked == b.checked && a.input_player == b.input_player && a.rendered_player == b.rendered_player;
}

void copyHead(const WorldTurn& from, WorldTurn& to) {
  to.watched = from.watched;
  to.wants_truth = from.wants_truth;
  to.ends_game = from.ends_game;
  to.checked = from.checked;
  to.input_player = from.input_player;
  to.rendered_player = from.rendered_player;
}

}  // namespace

std::uint8_t checkOf(std::uint64_t answer_hash) {
  return static_cast<std::uint8_t>(answer_hash >> 56);
}

TurnRecordWriter::TurnRecordWriter(const WorldTurn& last) {
  copyHead(last, m_last);
}

void dropKeys(WorldTurn& turn) {
  std::erase_if(turn.inputs, [](const df::InputQueue::Input& input) {
    return input.kind == df::InputQueue::kKey || input.kind == df::InputQueue::kMouse;
  });
}

// Replaces the frame's length by the record's length, which takes fewer bytes.
void TurnRecordWriter::append(std::string& out) {
  const std::string_view record = std::string_view(m_fields).substr(kWorldFrameHead);
  ByteWriter(out).varint(record.size());
  out.append(record);
}

bool TurnRecordWriter::write(const WorldTurn& turn, std::string& out) {
  if (turn.inputs.size() > kMaxTurnInputs) return false;
  FieldWriter fields(m_fields);
  const bool same = hasSameHead(turn, m_last) && !m_repeats_flags;
  m_repeats_flags = false;
  fields.number(same ? kRecordedTurn : kRecordedNewTurn, 0, 255);
  if (!same) {
    visitHead(fields, turn);
    copyHead(turn, m_last);
  }
  if (!turn.inputs.empty()) visitInputs(fields, turn.inputs);
  fields.finish();
  append(out);
  return true;
}

void TurnRecordWriter::write(const TickResult& result, std::string& out) {
  FieldWriter fields(m_fields);
  fields.number(kRecordedResult, 0, 255);
  visitResult(fields, result);
  fields.finish();
  append(out);
}

void TurnRecordWriter::write(const RecordedPicture& picture, std::string& out) {
  FieldWriter fields(m_fields);
  fields.number(kRecordedPicture, 0, 255);
  fields.number(picture.player);
  visitPicture(fields, picture.canvas);
  fields.finish();
  append(out);
}

void TurnRecordWriter::write(const PersistedSession& session, std::string& out) {
  FieldWriter fields(m_fields);
  fields.number(kRecordedSession, 0, 255);
  visitSession(fields, session);
  fields.finish();
  append(out);
}

void TurnRecordWriter::write(const InputsDropped& /*dropped*/, std::string& out) {
  FieldWriter fields(m_fields);
  fields.number(kRecordedDrop, 0, 255);
  fields.finish();
  append(out);
}

std::optional<TurnRecord> TurnRecordReader::next() {
  while (!m_bad && m_at < m_bytes.size()) {
    const std::string_view rest = std::string_view(m_bytes).substr(m_at);
    ByteReader head(rest);
    const std::uint64_t size = head.varint();
    if (!head.ok()) {  // incomplete, or not a varint
      m_bad = rest.size() >= 10;
      return std::nullopt;
    }
    if (size == 0 || size > kMaxTurnRecord) {
      m_bad = true;
      return std::nullopt;
    }
    const std::string_view record = head.bytes(size);
    if (!head.ok()) return std::nullopt;
    m_at += static_cast<std::size_t>(record.data() + record.size() - rest.data());
    auto read_record = read(record);
    if (m_at > kMaxTurnRecord || m_at == m_bytes.size()) {
      m_bytes.erase(0, m_at);
      m_at = 0;
    }
    if (read_record || m_bad) return read_record;
  }
  return std::nullopt;
}

std::optional<TurnRecord> TurnRecordReader::readTurn(FieldReader& in, std::uint8_t kind) {
  if (kind == kRecordedNewTurn) visitHead(in, m_last);
  WorldTurn turn;
  copyHead(m_last, turn);
  if (!in.isFullyRead()) visitInputs(in, turn.inputs);
  return turn;
}

std::optional<TurnRecord> TurnRecordReader::read(std::string_view record) {
  FieldReader in(record);
  std::uint8_t kind = 0;
  in.number(kind, 0, 255);
  std::optional<TurnRecord> found;
  if (kind == kRecordedTurn || kind == kRecordedNewTurn) {
    found = readTurn(in, kind);
  } else if (kind == kRecordedResult) {
    TickResult result;
    visitResult(in, result);
    found = result;
  } else if (kind == kRecordedPicture) {
    RecordedPicture picture;
    in.number(picture.player);
    visitPicture(in, picture.canvas);
    found = std::move(picture);
  } else if (kind == kRecordedSession) {
    PersistedSession session;
    visitSession(in, session);
    found = std::move(session);
  } else if (kind == kRecordedDrop) {
    found = InputsDropped();
  } else if (in.ok()) {
    return std::nullopt;  // unknown kind
  }
  if (in.isFullyRead()) return found;
  m_bad = true;
  return std::nullopt;
}

void appendTurnMessage(std::string_view record, bool copied, std::string& out) {
  char head[kWorldFrameHead];
  storeLittleEndian(static_cast<std::uint32_t>(record.size() + 1), head);
  out.append(head, sizeof head).push_back(copied ? 1 : 0);
  out.append(record);
}

std::optional<WorldTurn> readTurnMessage(std::string_view fields, TurnRecordReader& records, bool& copied) {
  if (fields.empty() || static_cast<unsigned char>(fields[0]) > 1) return std::nullopt;
  copied = fields[0] != 0;
  records.add(fields.substr(1));
  auto record = records.next();
  auto* p_turn = record ? std::get_if<WorldTurn>(&*record) : nullptr;
  return p_turn != nullptr && records.atEnd() ? std::optional(std::move(*p_turn)) : std::nullopt;
}

}  // namespace naiad
