// Opening a bus: who may have it (BusClaim), and why it is refused.
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "firmware/platform/socket_bus.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::platform {
namespace {

TEST(BusClaim, IsHeldByOneUntilItEnds) {
  const std::string name = "test/" + std::to_string(getpid());
  auto first = BusClaim::take(name);
  ASSERT_TRUE(std::holds_alternative<BusClaim>(first));
  const auto second = BusClaim::take(name);
  ASSERT_TRUE(std::holds_alternative<std::string>(second));
  const auto& why = std::get<std::string>(second);
  EXPECT_NE(why.find("process " + std::to_string(getpid())), std::string::npos) << why;
  EXPECT_NE(why.find("; remedy: "), std::string::npos) << why;
  EXPECT_TRUE(std::holds_alternative<BusClaim>(BusClaim::take(name + "x"))) << "another bus";
  { const auto moved = std::get<BusClaim>(std::move(first)); }
  EXPECT_TRUE(std::holds_alternative<BusClaim>(BusClaim::take(name)));
}

/// Of many processes that claim the bus at once, one gets it.
TEST(BusClaim, OneOfManyGetsIt) {
  const std::string name = "race/" + std::to_string(getpid());
  for (int round = 0; round < 20; ++round) {
    int start[2], told[2];
    ASSERT_EQ(pipe(start), 0);
    ASSERT_EQ(pipe(told), 0);
    constexpr int kTries = 8;
    std::array<pid_t, kTries> children{};
    for (pid_t& child : children) {
      child = fork();
      if (child != 0) continue;
      close(start[1]);
      char go = 0;
      if (read(start[0], &go, 1) != 0) _exit(2);  // all processes start when the parent closes the pipe
      const auto claim = BusClaim::take(name);
      const char got = std::holds_alternative<BusClaim>(claim) ? '1' : '0';
      if (write(told[1], &got, 1) != 1) _exit(2);
      pause();  // holds the claim until killed
      _exit(0);
    }
    close(start[0]);
    close(start[1]);
    int got = 0;
    for (int i = 0; i < kTries; ++i) {
      char one = 0;
      ASSERT_EQ(read(told[0], &one, 1), 1);
      got += one == '1';
    }
    EXPECT_EQ(got, 1);
    for (const pid_t child : children) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    EXPECT_TRUE(std::holds_alternative<BusClaim>(BusClaim::take(name))) << "the kernel takes it back";
    close(told[0]);
    close(told[1]);
  }
}

/// A device's socket as ligature-device creates it.
class OpenLocal : public ::testing::Test {
 protected:
  void SetUp() override {
    listener = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(listen(listener, 8), 0);
  }
  void TearDown() override {
    close(listener);
    std::filesystem::remove(path);
    std::filesystem::remove(folder + "other-name");
  }
  std::string folder = test::temp_folder(), path = folder + "hand";
  int listener = -1;
};

TEST_F(OpenLocal, ASecondControllerIsRefusedWhateverItCallsTheBus) {
  std::filesystem::create_symlink(path, folder + "other-name");
  auto first = open_can_bus("local:" + path);
  ASSERT_TRUE(std::holds_alternative<std::unique_ptr<CanBus>>(first));
  for (const std::string& name : {path, folder + "other-name", folder + "./hand"}) {
    const auto second = open_can_bus("local:" + name);
    const auto* error = std::get_if<OpenError>(&second);
    ASSERT_NE(error, nullptr) << name;
    EXPECT_EQ(error->kind, OpenFailure::kTaken);
    EXPECT_EQ(error->text.rfind("bus 'local:" + name + "': another controller", 0), 0U) << error->text;
  }
  std::get<0>(first).reset();
  EXPECT_TRUE(std::holds_alternative<std::unique_ptr<CanBus>>(open_can_bus("local:" + path)));
}

TEST_F(OpenLocal, NothingIsSentByWhoIsRefused) {
  auto first = open_can_bus("local:" + path);
  const int device = accept4(listener, nullptr, nullptr, SOCK_NONBLOCK);
  ASSERT_GE(device, 0);
  (void)open_can_bus("local:" + path);
  pollfd waiting{listener, POLLIN, 0};
  EXPECT_EQ(poll(&waiting, 1, 0), 0) << "it did not even connect";
  close(device);
}

OpenFailure failure_of(const std::string& url) {
  auto opened = open_can_bus(url);
  const auto* error = std::get_if<OpenError>(&opened);
  EXPECT_NE(error, nullptr) << url;
  if (error == nullptr) return OpenFailure::kUsage;
  EXPECT_NE(error->text.find(url), std::string::npos);
  return error->kind;
}

TEST(OpenCanBus, TellsBadUsageFromWhatIsNotThereYet) {
  EXPECT_EQ(failure_of("ethercat:0"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:/" + std::string(200, 'x')), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("socketcan:a-name-that-is-far-too-long"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:/nowhere/at/all"), OpenFailure::kNotThere);
  EXPECT_EQ(failure_of("socketcan:nosuchcan9"), OpenFailure::kUsage);
  EXPECT_EQ(failure_of("local:/tmp"), OpenFailure::kUsage);  // neither a folder nor a regular file can become a socket
  EXPECT_EQ(failure_of("local:/proc/self/stat"), OpenFailure::kUsage);
}

}  // namespace
}  // namespace ligature::platform
