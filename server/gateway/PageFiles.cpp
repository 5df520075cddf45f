#include "server/gateway/PageFiles.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeFile.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 64;
constexpr std::size_t kMaxBytes = std::size_t{64} << 20;  // total of all files
constexpr std::size_t kTagBytes = 12;                     // length of a tag, a part of a SHA-256
constexpr int kGzip = 15 + 16;  // zlib's windowBits: largest window (15), gzip format (+16)

struct TypeOfName {
  std::string_view ending;
  std::string_view type;
  bool packs;  // false: the format is already compressed
};
constexpr std::array<TypeOfName, 11> kTypes{{{".html", "text/html; charset=utf-8", true},
                                             {".css", "text/css; charset=utf-8", true},
                                             {".js", "text/javascript; charset=utf-8", true},
                                             {".wasm", "application/wasm", true},
                                             {".woff2", "font/woff2", false},
                                             {".svg", "image/svg+xml", true},
                                             {".png", "image/png", false},
                                             {".ico", "image/x-icon", false},
                                             {".json", "application/json", true},
                                             {".webmanifest", "application/manifest+json", true},
                                             {".txt", "text/plain; charset=utf-8", true}}};

const TypeOfName& typeOf(std::string_view name) {
  static constexpr TypeOfName kOther{"", "application/octet-stream", false};
  const auto* const found =
      std::ranges::find_if(kTypes, [name](const TypeOfName& type) { return name.ends_with(type.ending); });
  return found != kTypes.end() ? *found : kOther;
}

std::string tagOf(const std::string& content) {
  std::array<unsigned char, 32> hash{};
  unsigned int size = 0;
  if (EVP_Digest(content.data(), content.size(), hash.data(), &size, EVP_sha256(), nullptr) != 1)
    throw PageError("The files of the page cannot be hashed.");
  return "\"" + hexText({hash.data(), kTagBytes}) + "\"";
}

/// Returns the content compressed with gzip; empty if that does not save space.
std::string compressed(const std::string& content) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, MAX_MEM_LEVEL, Z_DEFAULT_STRATEGY) != Z_OK)
    return {};
  std::string result(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));  // zlib only reads
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  const bool done = deflate(&stream, Z_FINISH) == Z_STREAM_END;
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (!done || result.size() >= content.size()) return {};
  result.shrink_to_fit();
  return result;
}

PageFile pageFile(std::string_view name, std::string content) {
  const TypeOfName& type = typeOf(name);
  PageFile file{std::string(type.type), tagOf(content), std::move(content), {}};
  if (type.packs) file.compressed = compressed(file.content);
  return file;
}

}  // namespace

PageFiles::PageFiles(const fs::path& folder) {
  try {
    std::size_t left = kMaxBytes;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (!entry.is_regular_file() || name.starts_with('.') || !isPlainName(name)) continue;
      if (m_files.size() == kMaxFiles) throw PageError(folder.string() + " has more than 64 files.");
      std::string content = readSmallFile(entry.path(), left).value_or("");
      left -= content.size();
      m_files.emplace("/" + name, pageFile(name, std::move(content)));
    }
  } catch (const std::system_error& error) {
    throw PageError("The page in " + folder.string() + " cannot be read: " + error.what());
  }
  const auto index = m_files.find("/index.html");
  if (index == m_files.end()) throw PageError("There is no page in " + folder.string() + ": no index.html.");
  m_files.emplace("/", index->second);
}

const PageFile* PageFiles::find(std::string_view path) const {
  const auto found = m_files.find(path);
  return found != m_files.end() ? &found->second : nullptr;
}

}  // namespace naiad
