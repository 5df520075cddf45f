#include "GatewayRun.h"

#include <stdlib.h>

#include <fstream>

namespace naiad::test {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

std::string indexText() {
  std::string text = "<!doctype html><title>Naiad</title>";
  for (int i = 0; i < 100; ++i) text += "<p>a line of the page</p>";
  return text;
}

std::string wasmBytes() {
  std::string bytes("\0asm\1\0\0\0", 8);
  for (unsigned i = 0; i < 300'000; ++i) bytes.push_back(static_cast<char>(i * i >> 3));
  return bytes;
}

GatewayHome::GatewayHome() {
  std::filesystem::create_directories(path("page/folder"));
  write(path("page/index.html"), indexText());
  write(path("page/client.wasm"), wasmBytes());
  write(path("page/font.woff2"), "a font");
  write(path("page/.hidden"), "secret");
  write(path("page/folder/other.js"), "secret");
  write(path("secret.txt"), "secret");
}

GatewaySettings GatewayHome::settings(const ShortKey& key) const {
  GatewaySettings settings;
  settings.link = JoinLink{LinkHost{"game.test", kDefaultPort}, "", key};
  settings.visitors = path("visitors").string();
  settings.port = 0;
  settings.page = path("page");
  settings.name = "A \"game\"";
  return settings;
}

GatewayRun::GatewayRun(const GatewaySettings& settings)
    : m_gateway(settings,
                [this](const std::string& line) {
                  const std::lock_guard lock(m_mutex);
                  m_lines.push_back(line);
                }),
      m_port(m_gateway.port()),
      m_thread([this] { m_gateway.run(); }) {}

GatewayRun::~GatewayRun() {
  if (!m_thread.joinable()) return;
  stop();
  m_thread.join();
}

std::vector<std::string> GatewayRun::lines() {
  const std::lock_guard lock(m_mutex);
  return m_lines;
}

}  // namespace naiad::test
