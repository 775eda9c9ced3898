#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace telltale {

/// Writes DataFlash bytes one field at a time. It knows nothing of format characters: whoever
/// writes a record chooses the width of each field, and the length an FMT record claims, by hand.
class DataFlashWriter {
 public:
  DataFlashWriter& U8(std::uint64_t value) { return LittleEndian(value, 1); }
  DataFlashWriter& U16(std::uint64_t value) { return LittleEndian(value, 2); }
  DataFlashWriter& U32(std::uint64_t value) { return LittleEndian(value, 4); }
  DataFlashWriter& U64(std::uint64_t value) { return LittleEndian(value, 8); }
  // Two's complement: the low bytes of the sign-extended value.
  DataFlashWriter& I8(std::int64_t value) { return U8(static_cast<std::uint64_t>(value)); }
  DataFlashWriter& I16(std::int64_t value) { return U16(static_cast<std::uint64_t>(value)); }
  DataFlashWriter& I32(std::int64_t value) { return U32(static_cast<std::uint64_t>(value)); }
  DataFlashWriter& I64(std::int64_t value) { return U64(static_cast<std::uint64_t>(value)); }
  DataFlashWriter& F32(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return U32(bits);
  }
  DataFlashWriter& F64(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return U64(bits);
  }
  DataFlashWriter& Text(std::string_view text, std::size_t width) {
    for (std::size_t i = 0; i < width; ++i) {
      bytes_.push_back(i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0);
    }
    return *this;
  }
  DataFlashWriter& Header(int type) {
    return U8(0xA3).U8(0x95).U8(static_cast<std::uint64_t>(type));
  }
  DataFlashWriter& Raw(const std::vector<std::uint8_t>& bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }

  DataFlashWriter& Fmt(int type, int length, std::string_view name, std::string_view format,
                       std::string_view columns) {
    Header(128).U8(static_cast<std::uint64_t>(type)).U8(static_cast<std::uint64_t>(length));
    return Text(name, 4).Text(format, 16).Text(columns, 64);
  }

  std::size_t size() const { return bytes_.size(); }
  const std::vector<std::uint8_t>& Bytes() const { return bytes_; }
  std::vector<std::uint8_t>& Bytes() { return bytes_; }

 private:
  DataFlashWriter& LittleEndian(std::uint64_t value, int width) {
    for (int i = 0; i < width; ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(value & 0xFF));
      value >>= 8;
    }
    return *this;
  }

  std::vector<std::uint8_t> bytes_;
};

/// The messages of Rover 4.x: TimeUS, a GPS instance, units and multipliers.
class Rover4Writer : public DataFlashWriter {
 public:
  enum Type {
    kUnit = 129,
    kMult = 130,
    kFmtu = 131,
    kParm = 64,
    kGps = 94,
    kAtt = 72,
    kAhr2 = 70,
    kRcou = 188
  };

  Rover4Writer& Definitions() {
    Fmt(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    Fmt(kUnit, 76, "UNIT", "QbZ", "TimeUS,Id,Label");
    Fmt(kMult, 20, "MULT", "Qbd", "TimeUS,Id,Mult");
    Fmt(kFmtu, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds");
    Fmt(kParm, 35, "PARM", "QNff", "TimeUS,Name,Value,Default");
    Fmt(kGps, 51, "GPS", "QBBIHBcLLeffffB",
        "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U");
    Fmt(kAtt, 28, "ATT", "QccccCCCCB",
        "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,ErrRP,ErrYaw,AEKF");
    Fmt(kAhr2, 45, "AHR2", "QccCfLLffff", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng,Q1,Q2,Q3,Q4");
    Fmt(kRcou, 39, "RCOU", "QHHHHHHHHHHHHHH",
        "TimeUS,C1,C2,C3,C4,C5,C6,C7,C8,C9,C10,C11,C12,C13,C14");
    return *this;
  }

  Rover4Writer& Units() {
    Header(kUnit).U64(1000).I8('d').Text("deg", 64);
    Header(kMult).U64(1000).I8('B').F64(0.01);
    Header(kFmtu).U64(1000).U8(kAtt).Text("sddddhhdh-", 16).Text("FBBBBBBBB-", 16);
    return *this;
  }

  Rover4Writer& Parm(std::string_view name, float value) {
    Header(kParm).U64(2000).Text(name, 16).F32(value).F32(0.0f);
    return *this;
  }

  Rover4Writer& Output(int channel, int function, float min, float trim, float max, bool reversed) {
    const std::string servo = "SERVO" + std::to_string(channel);
    Parm(servo + "_FUNCTION", static_cast<float>(function));
    Parm(servo + "_MIN", min).Parm(servo + "_TRIM", trim).Parm(servo + "_MAX", max);
    return Parm(servo + "_REVERSED", reversed ? 1.0f : 0.0f);
  }

  /// Latitude and longitude in 1e-7 degrees, as they stand in the log.
  Rover4Writer& Gps(std::uint64_t time_us, int instance, int status, std::int64_t lat_e7,
                    std::int64_t lng_e7) {
    Header(kGps).U64(time_us).U8(static_cast<std::uint64_t>(instance));
    U8(static_cast<std::uint64_t>(status)).U32(130040903).U16(2200).U8(14).I16(80);
    I32(lat_e7).I32(lng_e7).I32(1234).F32(1.5f).F32(90.0f).F32(0.0f).F32(0.0f).U8(1);
    return *this;
  }

  /// Yaw in hundredths of a degree.
  Rover4Writer& Att(std::uint64_t time_us, int yaw_cdeg) {
    Header(kAtt).U64(time_us).I16(-5).I16(-6).I16(7).I16(8).U16(1);
    U16(static_cast<std::uint64_t>(yaw_cdeg)).U16(3).U16(4).U8(3);
    return *this;
  }

  Rover4Writer& Ahr2(std::uint64_t time_us, int yaw_cdeg) {
    Header(kAhr2).U64(time_us).I16(-6).I16(8).U16(static_cast<std::uint64_t>(yaw_cdeg));
    F32(1.0f).I32(0).I32(0).F32(1.0f).F32(0.0f).F32(0.0f).F32(0.0f);
    return *this;
  }

  /// The first three channels; the others hold 1500.
  Rover4Writer& Rcou(std::uint64_t time_us, int c1, int c2, int c3) {
    Header(kRcou).U64(time_us).U16(static_cast<std::uint64_t>(c1));
    U16(static_cast<std::uint64_t>(c2)).U16(static_cast<std::uint64_t>(c3));
    for (int channel = 4; channel <= 14; ++channel) U16(1500);
    return *this;
  }

  /// A boat heading north-east at 5 Hz GPS, 10 Hz ATT and RCOU; port on channel 3, starboard,
  /// reversed, on channel 1.
  Rover4Writer& Run(int fixes, std::uint64_t start_us = 10'000'000) {
    for (int i = 0; i < fixes; ++i) {
      const std::uint64_t now_us = start_us + static_cast<std::uint64_t>(i) * 200'000;
      Gps(now_us, 0, 3, 634014986 + 10 * i, 103146182 + 20 * i);
      for (int half = 0; half < 2; ++half) {
        const std::uint64_t then_us = now_us + static_cast<std::uint64_t>(half) * 100'000;
        Att(then_us + 1000, 4500 + i % 100);
        Rcou(then_us + 2000, 1411 - i % 100, 1500, 1611 + i % 100);
      }
    }
    return *this;
  }

  /// Everything a log of use has.
  Rover4Writer& WholeLog(int fixes) {
    Definitions().Units();
    Output(1, 74, 1100, 1511, 1900, true).Output(3, 73, 1100, 1511, 1900, false);
    return Run(fixes);
  }
};

}  // namespace telltale
