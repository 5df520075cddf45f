#include <gtest/gtest.h>

#include "host/program/Announcement.h"
#include "host/program/QrCode.h"
#include "host/settings/HostOptions.h"

namespace naiad {
namespace {

class QrCodeTest : public testing::Test {
 protected:
  QrCodeTest() : m_lines(qrCode("https://game.example/play")) {
    if (m_lines.empty()) return;
    for (const std::string& line : m_lines) {
      std::string upper;
      std::string lower;
      for (std::size_t at = 0; at < line.size();) {
        const std::string_view rest = std::string_view(line).substr(at);
        const bool full = rest.starts_with("█");
        const bool top = rest.starts_with("▀");
        const bool bottom = rest.starts_with("▄");
        upper += full || top ? '.' : '#';
        lower += full || bottom ? '.' : '#';
        at += full || top || bottom ? 3 : 1;
      }
      m_modules.push_back(upper);
      m_modules.push_back(lower);
    }
  }

  std::vector<std::string> m_lines;
  std::vector<std::string> m_modules;  ///< rows; '#' is a dark module
};

TEST_F(QrCodeTest, HasThreeFinderPatternsAndQuietZone) {
  if (m_lines.empty()) GTEST_SKIP() << "built without libqrencode";
  const std::size_t width = m_modules[0].size();
  ASSERT_EQ((width - 8 - 21) % 4, 0u) << "a side of 21 + 4k modules and twice 4 of quiet zone";
  ASSERT_GE(m_modules.size(), width);
  for (std::size_t y = 0; y < 4; ++y) EXPECT_EQ(m_modules[y], std::string(width, '.'));
  for (std::size_t y = width - 4; y < width; ++y) EXPECT_EQ(m_modules[y], std::string(width, '.'));
  for (std::size_t y = 0; y < width; ++y)
    EXPECT_EQ(m_modules[y].substr(0, 4) + m_modules[y].substr(width - 4), "........");
  const std::vector<std::string> finder = {"#######", "#.....#", "#.###.#", "#.###.#",
                                           "#.###.#", "#.....#", "#######"};
  for (const auto& [x, y] : {std::pair(4ul, 4ul), std::pair(width - 11, 4ul), std::pair(4ul, width - 11)}) {
    for (std::size_t row = 0; row < 7; ++row)
      EXPECT_EQ(m_modules[y + row].substr(x, 7), finder[row]) << x << ' ' << y;
  }
}

TEST_F(QrCodeTest, ServerWithoutTheLibraryReportsIt) {
  HostOptions options;
  EXPECT_TRUE(qrLines(options).empty());
  options.web_address = "https://game.example/play";
  options.qr = true;
  const std::vector<std::string> lines = qrLines(options);
  EXPECT_EQ(lines.size() == 1, m_lines.empty());
  EXPECT_EQ(lines.front().find("libqrencode") != std::string::npos, m_lines.empty());
}

TEST(QrCode, TooLongTextGivesNoCode) {
  EXPECT_TRUE(qrCode(std::string(5000, 'x')).empty());
}

}  // namespace
}  // namespace naiad
