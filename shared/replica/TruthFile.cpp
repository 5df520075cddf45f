#include "shared/replica/TruthFile.h"

#include <cstdio>
#include <vector>

namespace naiad {
namespace {

constexpr int kMaxExtent = 4096;

}  // namespace

TruthWriter::TruthWriter(const std::string& path) : m_out(path, std::ios::binary | std::ios::trunc) {}

void TruthWriter::write(std::uint32_t tick, std::uint32_t player, const df::Canvas& canvas) {
  m_buffer.clear();
  m_buffer.append("tick ").append(std::to_string(tick));
  m_buffer.append(" player ").append(std::to_string(player));
  m_buffer.append(" ").append(std::to_string(canvas.width()));
  m_buffer.append(" ").append(std::to_string(canvas.height())).append("\n");
  for (int y = 0; y < canvas.height(); ++y) m_buffer.append(canvas.rowText(y)).append("\n");
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const df::Cell cell = canvas.at(x, y);
      m_buffer.push_back(cell.ch == U' ' ? '.' : static_cast<char>('0' + cell.color));
    }
    m_buffer.push_back('\n');
  }
  m_buffer.push_back('\n');
  m_out.write(m_buffer.data(), static_cast<std::streamsize>(m_buffer.size()));
  m_out.flush();
}

TruthReader::TruthReader(const std::string& path) : m_in(path, std::ios::binary) {}

std::optional<TruthRecord> TruthReader::next() {
  // getline() also returns an incomplete last line, but then it sets eof.
  const auto line = [this](std::string& into) { return std::getline(m_in, into) && !m_in.eof(); };
  const auto malformed = [this]() -> std::optional<TruthRecord> {
    m_malformed = true;
    return std::nullopt;
  };
  std::string text;
  if (m_malformed || !line(text)) return std::nullopt;
  TruthRecord record;
  int width = 0;
  int height = 0;
  int end = 0;
  const int fields = std::sscanf(text.c_str(), "tick %u player %u %d %d%n", &record.tick, &record.player,
                                 &width, &height, &end);
  if (fields != 4 || end != static_cast<int>(text.size())) return malformed();
  if (width < 0 || height < 0 || width > kMaxExtent || height > kMaxExtent) return malformed();
  std::vector<std::u32string> rows;
  for (int y = 0; y < height; ++y) {
    if (!line(text)) return std::nullopt;
    rows.push_back(df::decodeUtf8(text));
    if (rows.back().size() != static_cast<std::size_t>(width)) return malformed();
  }
  record.canvas = df::Canvas(width, height);
  for (int y = 0; y < height; ++y) {
    if (!line(text)) return std::nullopt;
    if (text.size() != static_cast<std::size_t>(width)) return malformed();
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(x);
      const char digit = text[at];
      if (digit != '.' && (digit < '0' || digit > '7')) return malformed();
      const df::Color color = digit == '.' ? df::COLOR_DEFAULT : static_cast<df::Color>(digit - '0');
      record.canvas.put(x, y, {rows[static_cast<std::size_t>(y)][at], color});
    }
  }
  if (!line(text)) return std::nullopt;
  if (!text.empty()) return malformed();
  return record;
}

}  // namespace naiad
