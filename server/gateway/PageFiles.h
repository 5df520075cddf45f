// The files of the page, read once: what a browser asks for is looked up in a table and never on the disk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace naiad {

struct PageFile {
  std::string type;     ///< Content-Type
  std::string tag;      ///< ETag, in its quotes: of the content (RFC 9110 8.8.3)
  std::string content;  ///< as it is on the disk
  std::string packed;   ///< gzip; empty where that saves nothing
};

/// The page cannot be read; what() is a sentence.
class PageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Immutable. Memory: the files and what they pack into, 64 MiB of files at most.
class PageFiles {
 public:
  /// Every regular file of `folder`, not of folders in it, whose name has letters, digits, '.', '_' and '-'
  /// and begins with no dot. index.html is wanted, and is "/", too. Throws PageError.
  explicit PageFiles(const std::filesystem::path& folder);

  /// By the path of a URL, "/page.js". Null if there is none.
  const PageFile* find(std::string_view path) const;
  std::size_t size() const { return m_files.size(); }

 private:
  std::map<std::string, PageFile, std::less<>> m_files;
};

}  // namespace naiad
