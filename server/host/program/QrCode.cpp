#include "host/program/QrCode.h"

#include <memory>

#ifdef NAIAD_QRENCODE
#include <qrencode.h>
#endif

namespace naiad {

#ifdef NAIAD_QRENCODE

namespace {

constexpr int kQuietZone = 4;       // in modules
constexpr unsigned char kDark = 1;  // the bit of a module's byte

bool isLight(const QRcode& code, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < code.width && y < code.width;
  return !inside || (code.data[y * code.width + x] & kDark) == 0;
}

}  // namespace

std::vector<std::string> qrCode(const std::string& text) {
  const std::unique_ptr<QRcode, void (*)(QRcode*)> code(
      QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L), QRcode_free);
  if (!code) return {};
  std::vector<std::string> lines;
  const int end = code->width + kQuietZone;
  for (int y = -kQuietZone; y < end; y += 2) {
    std::string line;
    for (int x = -kQuietZone; x < end; ++x) {
      const bool upper = isLight(*code, x, y);
      const bool lower = y + 1 < end && isLight(*code, x, y + 1);
      line += upper ? (lower ? "█" : "▀") : (lower ? "▄" : " ");
    }
    lines.push_back(line);
  }
  return lines;
}

#else

std::vector<std::string> qrCode(const std::string&) {
  return {};
}

#endif

}  // namespace naiad
