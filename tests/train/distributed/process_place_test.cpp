#include "train/distributed/process_place.hpp"

#include <cstdlib>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Variables = std::map<std::string, std::string>;

class ProcessPlaceTest : public testing::Test {
 protected:
  ProcessPlaceTest() { clear(); }
  ~ProcessPlaceTest() override { clear(); }

  static void clear() {
    for (const char* name :
         {"RANK", "WORLD_SIZE", "MASTER_ADDR", "MASTER_PORT", "LOCAL_RANK", "LOCAL_WORLD_SIZE",
          "SLURM_PROCID", "SLURM_NTASKS", "SLURM_LOCALID", "SLURM_TASKS_PER_NODE",
          "TORCHELASTIC_USE_AGENT_STORE", "TORCHELASTIC_RESTART_COUNT"}) {
      unsetenv(name);
    }
  }
  static ProcessPlace place(const Variables& variables) {
    clear();
    for (const auto& [name, value] : variables) setenv(name.c_str(), value.c_str(), 1);
    return read_process_place();
  }
  static std::string mistake(const Variables& variables) {
    try {
      place(variables);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "no mistake";
  }
};

const Variables kTorchrun{
    {"RANK", "5"},       {"WORLD_SIZE", "8"},      {"MASTER_ADDR", "node1"}, {"MASTER_PORT", "29500"},
    {"LOCAL_RANK", "1"}, {"LOCAL_WORLD_SIZE", "4"}};
const Variables kSlurm{{"SLURM_PROCID", "3"},
                       {"SLURM_NTASKS", "6"},
                       {"MASTER_ADDR", "node1"},
                       {"SLURM_LOCALID", "1"},
                       {"SLURM_TASKS_PER_NODE", "2(x3)"},
                       {"MASTER_PORT", "29500"}};

Variables with(Variables variables, const std::string& name, const std::string& value) {
  variables[name] = value;
  return variables;
}

TEST_F(ProcessPlaceTest, WithoutVariablesThereIsOneProcess) {
  EXPECT_EQ(place({}).size, 1);
  EXPECT_EQ(place({{"SLURM_PROCID", "3"}, {"SLURM_NTASKS", "6"}}).size, 1) << "an ordinary Slurm job";
}

TEST_F(ProcessPlaceTest, ReadsTorchrunsVariables) {
  const ProcessPlace p = place(kTorchrun);
  EXPECT_EQ(p.rank, 5);
  EXPECT_EQ(p.size, 8);
  EXPECT_EQ(p.local_rank, 1);
  EXPECT_EQ(p.local_size, 4);
  EXPECT_EQ(p.master_address, "node1");
  EXPECT_EQ(p.master_port, 29500);
  EXPECT_FALSE(p.served || p.on_loopback());
  EXPECT_TRUE(place(with(kTorchrun, "TORCHELASTIC_USE_AGENT_STORE", "True")).served);
}

TEST_F(ProcessPlaceTest, SlurmsNumbersStandInWhereTheAddressIsGiven) {
  const ProcessPlace p = place(kSlurm);
  EXPECT_EQ(p.rank, 3);
  EXPECT_EQ(p.size, 6);
  EXPECT_EQ(p.local_rank, 1);
  EXPECT_EQ(p.local_size, 2);
  Variables torchrun_in_slurm = kSlurm;
  torchrun_in_slurm.insert(kTorchrun.begin(), kTorchrun.end());
  EXPECT_EQ(place(torchrun_in_slurm).rank, 5) << "torchrun's count inside a Slurm job";
}

TEST_F(ProcessPlaceTest, OnTheLoopbackDeviceAllAreOnThisMachine) {
  Variables variables = with(kTorchrun, "MASTER_ADDR", "127.0.0.1");
  variables.erase("LOCAL_WORLD_SIZE");
  EXPECT_EQ(place(variables).local_size, 8);
}

TEST_F(ProcessPlaceTest, NamesWhatIsMissing) {
  EXPECT_THAT(mistake({{"RANK", "0"}, {"WORLD_SIZE", "2"}}),
              AllOf(HasSubstr("MASTER_ADDR, MASTER_PORT, LOCAL_RANK is missing"), HasSubstr("launch.sh")));
  for (const char* name : {"RANK", "WORLD_SIZE", "MASTER_ADDR", "MASTER_PORT", "LOCAL_RANK"}) {
    EXPECT_THAT(mistake(with(kTorchrun, name, "")), HasSubstr(std::string(", ") + name + " is missing"));
  }
  EXPECT_THAT(mistake(with(kSlurm, "MASTER_PORT", "")), HasSubstr(", MASTER_PORT is missing"));
  EXPECT_THAT(mistake(with(kSlurm, "RANK", "3")), HasSubstr(", WORLD_SIZE, LOCAL_RANK is missing"))
      << "half of torchrun's count is no reason to take the rest from Slurm";
}

TEST_F(ProcessPlaceTest, RefusesNumbersThatCannotBe) {
  EXPECT_THAT(mistake(with(kTorchrun, "RANK", "8")), HasSubstr("RANK: \"8\" is not between 0 and 7"));
  EXPECT_THAT(mistake(with(kTorchrun, "RANK", "1x")), HasSubstr("RANK: \"1x\""));
  EXPECT_THAT(mistake(with(kTorchrun, "WORLD_SIZE", "0")), HasSubstr("WORLD_SIZE: \"0\""));
  EXPECT_THAT(mistake(with(kTorchrun, "MASTER_PORT", "70000")), HasSubstr("MASTER_PORT: \"70000\""));
  EXPECT_THAT(mistake(with(kTorchrun, "LOCAL_WORLD_SIZE", "1")), HasSubstr("LOCAL_WORLD_SIZE: \"1\""));
  EXPECT_THAT(mistake(with(kSlurm, "SLURM_PROCID", "6")), HasSubstr("SLURM_PROCID: \"6\""));
}

}  // namespace
}  // namespace alight
