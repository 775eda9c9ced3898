#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "support/dataflash_writer.hpp"

namespace {

void Save(const std::filesystem::path& file, const telltale::DataFlashWriter& writer) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(writer.Bytes().data()),
            static_cast<std::streamsize>(writer.size()));
}

}  // namespace

/// dataflash_seeds FOLDER: the logs from which the fuzzer starts.
int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: dataflash_seeds FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);

  telltale::Rover4Writer rover;
  rover.WholeLog(3);
  Save(folder / "rover4.BIN", rover);

  telltale::Rover4Writer receivers;
  receivers.Definitions().Gps(1, 0, 3, 1, 2).Gps(2, 1, 1, 3, 4).Ahr2(3, 100).Rcou(4, 1, 2, 3);
  receivers.Parm("RC1_FUNCTION", 73).Parm("RC2_REV", -1);
  Save(folder / "receivers.BIN", receivers);

  telltale::DataFlashWriter formats;
  formats.Fmt(1, 62, "NUM", "bBhHiIfdcCeELMqQ", "b,B,h,H,i,I,f,d,c,C,e,E,L,M,q,Q");
  formats.Fmt(2, 153, "TXT", "gnNZa", "g,n,N,Z,a");
  formats.Header(1).Text("", 59).Header(2).Text("", 150);
  Save(folder / "formats.BIN", formats);

  telltale::DataFlashWriter old;
  old.Fmt(130, 17, "GPS", "BLLIB", "Status,Lat,Lng,T,I").Fmt(136, 9, "ATT", "IC", "TimeMS,Yaw");
  old.Fmt(140, 11, "RCOU", "Ihh", "TimeMS,Ch1,Ch2");
  old.Header(130).U8(3).I32(1).I32(2).U32(3).U8(1).Header(136).U32(4).U16(5);
  old.Header(140).U32(6).I16(7).I16(8).Header(130).U8(3);
  Save(folder / "old.BIN", old);
}
