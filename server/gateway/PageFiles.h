// The files of the page, read once at the start. Requests are looked up in a table, never on disk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace naiad {

struct PageFile {
  std::string type;        ///< Content-Type
  std::string tag;         ///< ETag with its quotes, a hash of the content (RFC 9110 8.8.3)
  std::string content;     ///< the file, uncompressed
  std::string compressed;  ///< the file compressed with gzip; empty if not smaller, or for types like PNG
};

/// Thrown if the page cannot be read. what() is a one-sentence message.
class PageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Immutable. Holds the files (64 MiB at most) and their compressed forms in memory.
class PageFiles {
 public:
  /// Reads the regular files of `folder` (not of subfolders) whose names consist of letters, digits, '.', '_'
  /// and '-' and do not begin with a dot. index.html is required; it is served as "/", too. Throws PageError.
  explicit PageFiles(const std::filesystem::path& folder);

  /// Returns the file for a URL path like "/page.js"; null if it does not exist.
  const PageFile* find(std::string_view path) const;
  std::size_t size() const { return m_files.size(); }

 private:
  std::map<std::string, PageFile, std::less<>> m_files;
};

}  // namespace naiad
