// Packs the records of turns by an adaptive model and an arithmetic coder.
//
// A second of a game is some 500 bytes, of which hardly 100 say anything. A general packer works in blocks
// and by whole bytes: flushed each second, zstd (level 6) leaves 7.1 bytes of a tick in which four players
// press keys at random, and 5.8 flushed each minute; this leaves 4.0, of which the checks are 1.3. Bits are
// predicted from the bytes before and the place in the record, as lpaq does (Matt Mahoney, 2007): each
// context has a probability, a mixer weighs them by how good they were. Integers alone, so the same
// everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace naiad {

/// What comes next in the stream of records, bit by bit. Both ends have one, and it sees the same bytes.
class RecordModel {
 public:
  RecordModel();
  ~RecordModel();
  RecordModel(RecordModel&& other) noexcept;
  RecordModel& operator=(RecordModel&&) = delete;
  /// That the next bit is 1, of 65,536: 1 to 65,535.
  std::uint32_t predict();
  /// It was this.
  void update(bool bit);

 private:
  static constexpr int kContexts = 6;
  static constexpr int kSlotBits = 14;
  struct Tables;

  void beginByte();
  void followRecord(std::uint8_t byte);
  void followInput(std::uint8_t byte);

  std::unique_ptr<Tables> m_tables;
  std::array<std::uint32_t, kContexts> m_hashes{};  ///< of the contexts of this byte
  std::array<std::uint32_t, kContexts> m_slots{};
  std::array<std::int32_t, kContexts> m_inputs{};
  std::uint32_t m_partial = 1;  ///< the byte's bits so far, behind a 1
  std::uint32_t m_history = 0;  ///< the last four bytes
  std::uint32_t m_place = 0;    ///< in the record, its length not counted
  std::uint64_t m_left = 0;     ///< bytes of the record
  std::uint32_t m_kind = 0;     ///< of the record
  std::uint32_t m_input = 0;    ///< kind of the input that the next byte is in, of a turn
  std::uint32_t m_field = 0;    ///< the byte's place in it
  std::uint32_t m_player = 0;   ///< whose it is, or was the one before
  std::uint32_t m_predicted = 0;
};

/// The next bytes of the stream, packed so that a RecordUnpacker that has all before has these, too.
class RecordPacker {
 public:
  RecordPacker() = default;
  /// Goes on where an unpacker is.
  explicit RecordPacker(RecordModel model) : m_model(std::move(model)) {}
  void pack(std::string_view records, std::string& out);

 private:
  RecordModel m_model;
};

class RecordUnpacker {
 public:
  /// `count` bytes. Any bytes are something.
  void unpack(std::string_view packed, std::size_t count, std::string& out);
  /// For a packer that goes on; nothing can be unpacked from then on.
  RecordModel takeModel() { return std::move(m_model); }

 private:
  RecordModel m_model;
};

}  // namespace naiad
