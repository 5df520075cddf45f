#include "host/journal/TurnRecord.h"

#include <utility>

namespace naiad {

namespace {

enum RecordKind : std::uint8_t {
  kRecordedTurn = 0,     ///< with the flags and players of the turn before
  kRecordedNewTurn = 1,  ///< with its own
  kRecordedResult = 2,
  kRecordedPicture = 3,
  kRecordedSession = 4,
  kRecordedDrop = 5,
};

template <class F, class T>
void visitHead(F& f, T& turn) {
  f.flag(turn.watched);
  f.flag(turn.wants_truth);
  f.flag(turn.ends_game);
  f.flag(turn.checked);
  f.number(turn.heard_player);
  f.number(turn.pictured);
}

template <class F, class T>
void visitInputs(F& f, T& inputs) {
  f.list(inputs, kMaxTurnInputs, [](F& in, auto& input) { visitTurnInput(in, input); });
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
  f.text(session.name, kMaxKeptName);
  f.number(session.color, df::BLACK, df::WHITE);
  for (auto* p_hash : {&session.newest, &session.redeemed}) f.text(*p_hash, kKeptHash);
}

bool hasSameHead(const WorldTurn& a, const WorldTurn& b) {
  return a.watched == b.watched && a.wants_truth == b.wants_truth && a.ends_game == b.ends_game &&
         a.checked == b.checked && a.heard_player == b.heard_player && a.pictured == b.pictured;
}

void copyHead(const WorldTurn& from, WorldTurn& to) {
  to.watched = from.watched;
  to.wants_truth = from.wants_truth;
  to.ends_game = from.ends_game;
  to.checked = from.checked;
  to.heard_player = from.heard_player;
  to.pictured = from.pictured;
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

// The frame's length is taken off, and the record's, which is shorter, put in its place.
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

void TurnRecordWriter::write(const KeptSession& session, std::string& out) {
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
    if (!head.ok()) {  // cut off in the middle of the length, or never one
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
  if (!in.isWhole()) visitInputs(in, turn.inputs);
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
    KeptSession session;
    visitSession(in, session);
    found = std::move(session);
  } else if (kind == kRecordedDrop) {
    found = InputsDropped();
  } else if (in.ok()) {
    return std::nullopt;  // unknown
  }
  if (in.isWhole()) return found;
  m_bad = true;
  return std::nullopt;
}

}  // namespace naiad
