// Packs the records of turns with an adaptive model and an arithmetic coder.
//
// A second of a game has about 500 bytes, of which barely 100 carry information. A general packer works in
// blocks and whole bytes: flushed each second, zstd (level 6) needs 7.1 bytes for a tick in which four
// players press keys at random, and 5.8 when flushed each minute. This coder needs 4.0, of which the checks
// are 1.3. It predicts bits from the bytes before and the position in the record, as lpaq does (Matt Mahoney,
// 2007): each context has a probability, and a mixer weights them by their past success. All arithmetic is on
// integers, so the result is equal on all machines.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace naiad {

/// Predicts the record stream bit by bit. Packer and unpacker have one each, and both see the same bytes.
class RecordModel {
 public:
  RecordModel();
  ~RecordModel();
  RecordModel(RecordModel&& other) noexcept;
  RecordModel& operator=(RecordModel&&) = delete;
  /// Returns the probability that the next bit is 1, in 65,536ths; never 0 or 65,536.
  std::uint32_t predict();
  /// Learns the value of the bit that predict() has predicted.
  void update(bool bit);

 private:
  static constexpr int kContexts = 6;
  static constexpr int kSlotBits = 14;
  struct Tables;

  void beginByte();
  void followRecord(std::uint8_t byte);
  void followInput(std::uint8_t byte);

  std::unique_ptr<Tables> m_tables;
  std::array<std::uint32_t, kContexts> m_hashes{};  ///< hashes of the next byte's contexts
  std::array<std::uint32_t, kContexts> m_slots{};
  std::array<std::int32_t, kContexts> m_inputs{};
  std::uint32_t m_partial = 1;  ///< known bits of the next byte, with a 1 before them
  std::uint32_t m_history = 0;  ///< the last four bytes
  std::uint32_t m_place = 0;    ///< number of the record's known bytes, without its length byte
  std::uint64_t m_left = 0;     ///< bytes of the record that are left
  std::uint32_t m_kind = 0;     ///< kind of the record plus 1; 0: not read yet
  std::uint32_t m_input = 0;    ///< in a turn: kind of the input that the next byte belongs to
  std::uint32_t m_field = 0;    ///< position of the next byte in that input
  std::uint32_t m_player =
      0;  ///< first byte of that input's player; until it is read, of the previous input's
  std::uint32_t m_predicted = 0;
};

/// Packs the next bytes of the stream. A RecordUnpacker that has unpacked all bytes before can unpack these.
class RecordPacker {
 public:
  RecordPacker() = default;
  /// Continues with the model of an unpacker.
  explicit RecordPacker(RecordModel model) : m_model(std::move(model)) {}
  void pack(std::string_view records, std::string& out);

 private:
  RecordModel m_model;
};

class RecordUnpacker {
 public:
  /// Appends `count` unpacked bytes to `out`. Cannot fail: any input decodes to something.
  void unpack(std::string_view packed, std::size_t count, std::string& out);
  /// Returns the model, for a packer that continues. Nothing can be unpacked afterwards.
  RecordModel releaseModel() { return std::move(m_model); }

 private:
  RecordModel m_model;
};

}  // namespace naiad
