// CSV, files, output folder, hash and durations.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/hash.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/progress.h"
#include "base/error.h"
#include "tests/scratch_folder.h"

namespace trackbed::apps {
namespace {

class Output : public testing::Test, public ScratchFolder {};

TEST_F(Output, CsvKeepsEveryBitOfADouble) {
  const double values[] = {0.1, 1.0 / 3, 1e-300, -2.5e17, 5e-324};
  {
    CsvWriter csv(file("a.csv"), {"x_m"});
    for (double v : values) csv.row({v});
  }
  std::ifstream in(file("a.csv"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "x_m");
  for (double v : values) {
    std::getline(in, line);
    EXPECT_EQ(std::strtod(line.c_str(), nullptr), v) << line;
  }
}

TEST_F(Output, CsvRefusesWhatIsNotFinite) {
  CsvWriter csv(file("a.csv"), {"time_s", "u_m"});
  EXPECT_THROW(csv.row({0.0, std::nan("")}), RunError);
  EXPECT_THROW(csv.row({std::numeric_limits<double>::infinity(), 0.0}), RunError);
  EXPECT_THROW(csv.row({0.0}), RunError);
  csv.row({0.0, CsvCell()});  // an empty cell is no number at all
  csv.flush();
  EXPECT_EQ(read_text(file("a.csv")), "time_s,u_m\n0,\n");
}

TEST_F(Output, CsvResumesAtTheCheckpointsRow) {
  {
    CsvWriter csv(file("a.csv"), {"cycle", "u_m"});
    for (int i = 0; i < 5; ++i) csv.row({i, 0.5 * i});
    EXPECT_EQ(csv.rows(), 5u);
  }
  {
    auto csv = CsvWriter::resume(file("a.csv"), {"cycle", "u_m"}, 2);
    csv.row({2, "again"});
  }
  EXPECT_EQ(read_text(file("a.csv")), "cycle,u_m\n0,0\n1,0.5\n2,again\n");
  EXPECT_THROW(CsvWriter::resume(file("a.csv"), {"cycle", "u_m"}, 4), InputError);
  EXPECT_THROW(CsvWriter::resume(file("a.csv"), {"cycle", "v_m"}, 1), InputError);
  EXPECT_THROW(CsvWriter::resume(file("b.csv"), {"cycle"}, 0), InputError);
}

TEST_F(Output, AFullDiskIsNamed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  try {
    CsvWriter csv("/dev/full", {"x"});
    FAIL();
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos);
  }
}

TEST_F(Output, WritingAsideLeavesTheOldFileWhole) {
  write_aside_then_rename(file("a.txt"), "old");
  std::filesystem::create_directory(aside_name(file("a.txt")));  // the next one must fail
  EXPECT_THROW(write_aside_then_rename(file("a.txt"), "new"), RunError);
  EXPECT_EQ(read_text(file("a.txt")), "old");
  std::filesystem::remove(aside_name(file("a.txt")));
  write_aside_then_rename(file("a.txt"), "new");
  EXPECT_EQ(read_text(file("a.txt")), "new");
}

TEST_F(Output, AFolderWithARunIsKept) {
  const std::string run = file("run");
  write_aside_then_rename(file("mine.txt"), "keep");
  { OutputFolder fresh(run, EarlierRun::refuse); }
  EXPECT_THROW(OutputFolder(run, EarlierRun::resume), InputError);  // no checkpoint yet
  write_aside_then_rename(run + "/history.csv", "time_s\n");
  write_aside_then_rename(run + "/notes.txt", "keep");
  EXPECT_THROW(OutputFolder(run, EarlierRun::refuse), InputError);
  EXPECT_TRUE(std::filesystem::exists(run + "/history.csv"));
  { OutputFolder replaced(run, EarlierRun::overwrite); }
  EXPECT_FALSE(std::filesystem::exists(run + "/history.csv"));
  EXPECT_TRUE(std::filesystem::exists(run + "/notes.txt"));
}

TEST_F(Output, TwoRunsDoNotShareAFolder) {
  OutputFolder first(file("run"), EarlierRun::refuse);
  EXPECT_THROW(OutputFolder(file("run"), EarlierRun::refuse), InputError);
}

TEST_F(Output, AFolderBelowAFileIsRefused) {
  write_aside_then_rename(file("plain"), "");
  EXPECT_THROW(OutputFolder(file("plain/run"), EarlierRun::refuse), InputError);
  EXPECT_THROW(OutputFolder(file("plain"), EarlierRun::refuse), InputError);
}

TEST(Hash, IsFnv1a) {
  EXPECT_EQ(hash_name(""), "cbf29ce484222325");
  EXPECT_EQ(hash_name("foobar"), "85944171f73967e8");
}

TEST(Progress, SaysDurationsAsPeopleDo) {
  EXPECT_EQ(duration_text(45.2), "45 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(3900), "1 h 05 min");
  EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), "1000000 h 00 min");
}

}  // namespace
}  // namespace trackbed::apps
