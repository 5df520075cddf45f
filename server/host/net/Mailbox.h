// Messages from one thread to another, in batches.
//
// A writer fills its own Batch and puts it into the Mailbox from time to time; the reader takes everything in
// it at once. Both hold the lock only to swap or append vectors, so neither waits long for the other. While
// the reader takes each batch before the next one is put in, memory is reused and nothing is allocated.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

namespace naiad {

/// Headers in the order in which they were added, each with some bytes. Not thread-safe.
template <class Header>
class Batch {
 public:
  void add(const Header& header, std::string_view bytes = {}) {
    m_items.push_back({header, static_cast<std::uint32_t>(bytes.size())});
    m_bytes.insert(m_bytes.end(), bytes.begin(), bytes.end());
  }
  void append(const Batch& other) {
    m_items.insert(m_items.end(), other.m_items.begin(), other.m_items.end());
    m_bytes.insert(m_bytes.end(), other.m_bytes.begin(), other.m_bytes.end());
  }
  /// Reads the next unread header and its bytes, which are valid until the batch changes. False after the
  /// last one; then the batch is empty again.
  bool read(Header& header, std::string_view& bytes) {
    if (m_read == m_items.size()) {
      clear();
      return false;
    }
    const Item& item = m_items[m_read++];
    header = item.header;
    bytes = {m_bytes.data() + m_begin, item.size};
    m_begin += item.size;
    return true;
  }
  bool empty() const { return m_items.empty(); }
  /// Memory in use, in bytes.
  std::size_t size() const { return m_bytes.size() + m_items.size() * sizeof(Item); }

 private:
  struct Item {
    Header header;
    std::uint32_t size;
  };
  /// A buffer larger than this is released after a batch that uses less than a quarter of it. In bytes.
  static constexpr std::size_t kMaxIdleCapacity = std::size_t{1} << 22;

  void clear() {
    const bool large = m_bytes.capacity() > kMaxIdleCapacity && m_bytes.size() < m_bytes.capacity() / 4;
    m_items.clear();
    m_bytes.clear();
    if (large) m_bytes.shrink_to_fit();
    m_read = m_begin = 0;
  }

  std::vector<Item> m_items;
  std::vector<char> m_bytes;
  std::size_t m_read = 0;
  std::size_t m_begin = 0;
};

/// Thread-safe, one reader and one writer.
template <class Header>
class Mailbox {
 public:
  /// Moves all of `batch` into the mailbox. `batch` is empty afterwards.
  void push(Batch<Header>& batch) {
    const std::lock_guard lock(m_mutex);
    if (m_waiting.empty()) {
      std::swap(m_waiting, batch);
    } else {
      m_waiting.append(batch);
      batch = {};
    }
    m_size = m_waiting.size();
  }
  /// Moves everything in the mailbox to `batch`, which must be empty.
  void popAll(Batch<Header>& batch) {
    const std::lock_guard lock(m_mutex);
    std::swap(m_waiting, batch);
    m_size = 0;
  }
  /// Bytes that the reader has not taken yet.
  std::size_t size() const { return m_size; }

 private:
  std::mutex m_mutex;
  Batch<Header> m_waiting;
  std::atomic<std::size_t> m_size = 0;
};

}  // namespace naiad
