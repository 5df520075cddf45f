#include "host/world/WorldMessages.h"

#include <algorithm>
#include <utility>

#include "host/world/BuildId.h"
#include "shared/replica/Limits.h"

namespace naiad {

namespace {

void visitHash(FieldWriter& out, std::uint64_t hash) {
  out.number(static_cast<std::uint32_t>(hash));
  out.number(static_cast<std::uint32_t>(hash >> 32));
}

void visitHash(FieldReader& in, std::uint64_t& hash) {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  in.number(low);
  in.number(high);
  hash = std::uint64_t{high} << 32 | low;
}

template <class F, class T>
void visitFile(F& f, T& file) {
  f.text(file.name, kMaxReadFileName);
  visitHash(f, file.hash);
}

bool isHex(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
}

template <class F, class T>
void visitReady(F& f, T& ready) {
  f.number(ready.window_width, kMinViewWidth, kMaxViewWidth);
  f.number(ready.window_height, kMinViewHeight, kMaxViewHeight);
  f.number(ready.frame_millis, 1, kMaxFrameMillis);
  f.flag(ready.compat);
  f.flag(ready.fixed_addresses);
  f.flag(ready.runs_empty);
  f.list(ready.help, kMaxHelpLines, [](F& in, auto& line) { in.text(line, kMaxHelpLength); });
  f.list(ready.files, kMaxReadFiles, [](F& in, auto& file) { visitFile(in, file); });
}

/// Visits flags as one number, the first in the lowest bit.
template <class... Flags>
void visitFlags(FieldWriter& out, const Flags&... flags) {
  std::uint32_t bits = 0;
  int at = 0;
  ((bits |= static_cast<std::uint32_t>(flags) << at++), ...);
  out.number(bits, 0, (1 << sizeof...(flags)) - 1);
}

template <class... Flags>
void visitFlags(FieldReader& in, Flags&... flags) {
  std::uint32_t bits = 0;
  int at = 0;
  in.number(bits, 0, (1 << sizeof...(flags)) - 1);
  ((flags = (bits >> at++ & 1) != 0), ...);
}

void visitCanvas(FieldWriter& out, const df::Canvas& canvas) {
  out.number(canvas.width(), 0, kMaxViewWidth);
  out.number(canvas.height(), 0, kMaxViewHeight);
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const df::Cell cell = canvas.at(x, y);
      out.number(static_cast<std::uint32_t>(cell.ch));
      out.number(cell.color, df::BLACK, df::WHITE);
    }
  }
}

void visitCanvas(FieldReader& in, df::Canvas& canvas) {
  int width = 0;
  int height = 0;
  in.number(width, 0, kMaxViewWidth);
  in.number(height, 0, kMaxViewHeight);
  canvas = df::Canvas(width, height);
  for (int i = 0; i < width * height && in.ok(); ++i) {
    df::Cell cell;
    std::uint32_t ch = 0;
    in.number(ch);
    in.number(cell.color, df::BLACK, df::WHITE);
    cell.ch = static_cast<char32_t>(ch);
    in.require(df::isDrawable(cell.ch));
    canvas.put(i % width, i / width, cell);
  }
}

template <class F, class T>
void visitAnswer(F& f, T& answer) {
  f.flag(answer.game_over);
  f.list(answer.leavers, kMaxViewPlayers, [](F& in, auto& leaver) { in.number(leaver); });
  f.list(answer.scores, df::HighScoreLimits::kMaxAddedInTick, [](F& in, auto& added) {
    visitScore(in, added.table, added.score.name, added.score.points);
    in.number(added.tick);
    in.number(added.number, 0, df::ScoreTables::kMaxNumber);
  });
  f.list(answer.sent, df::GameRoomLimits::kMaxSentInTick, [](F& in, auto& sent) {
    in.number(sent.player);
    in.text(sent.room, df::GameRoomLimits::kMaxName);
  });
  f.list(answer.pictures, kMaxViewPlayers, [](F& in, auto& picture) {
    in.number(picture.player);
    visitCanvas(in, picture.canvas);
  });
  bool has_hash = answer.state_hash.has_value();
  visitFlags(f, answer.has_view, has_hash);
  std::uint64_t hash = answer.state_hash.value_or(0);
  if (has_hash) visitHash(f, hash);
  if constexpr (F::kReads) answer.state_hash = has_hash ? std::optional(hash) : std::nullopt;
}

}  // namespace

void visitPicture(FieldWriter& out, const df::Canvas& canvas) {
  visitCanvas(out, canvas);
}

void visitPicture(FieldReader& in, df::Canvas& canvas) {
  visitCanvas(in, canvas);
}

void writeReady(const WorldReady& ready, std::string& frame) {
  FieldWriter out(frame);
  out.text(ownBuildId(), kMaxBuildId);
  visitReady(out, ready);
  out.finish();
}

std::optional<std::string> readBuild(std::string_view fields) {
  FieldReader in(fields);
  std::string build;
  in.text(build, kMaxBuildId);
  in.require(std::all_of(build.begin(), build.end(), isHex));
  return in.ok() ? std::optional(std::move(build)) : std::nullopt;
}

std::optional<WorldReady> readReady(std::string_view fields) {
  FieldReader in(fields);
  std::string build;
  in.text(build, kMaxBuildId);
  in.require(build == ownBuildId());
  WorldReady ready;
  visitReady(in, ready);
  return in.isFullyRead() ? std::optional(std::move(ready)) : std::nullopt;
}

bool writeAnswer(const WorldAnswer& answer, const df::WorldView* p_view, ViewWriter& views,
                 std::string& frame) {
  FieldWriter out(frame);
  visitAnswer(out, answer);
  if (p_view != nullptr) views.write(out, *p_view);
  return out.finish();
}

std::optional<WorldAnswer> readAnswer(std::string_view fields, ViewReader& views, df::WorldView& view) {
  FieldReader in(fields);
  WorldAnswer answer;
  visitAnswer(in, answer);
  if (in.ok() && answer.has_view) views.read(in, view);
  return in.isFullyRead() ? std::optional(std::move(answer)) : std::nullopt;
}

std::optional<WorldAnswer> readAnswerHead(std::string_view fields) {
  FieldReader in(fields);
  WorldAnswer answer;
  visitAnswer(in, answer);
  return in.ok() ? std::optional(std::move(answer)) : std::nullopt;
}

}  // namespace naiad
