// LocalPort, the simulated device's end of a `local:` bus, with real sockets in a temporary folder; nothing waits.

#include "sim_device/local_port.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "protocol/can/local_wire.hpp"
#include "protocol/can/nmt.hpp"

namespace ligature::sim {
namespace {

class LocalPortTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "port-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    path_ = folder_ / "bus";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<Port> open() { return std::move(std::get<std::unique_ptr<Port>>(LocalPort::open(path_.string()))); }
  std::string refusal() { return std::get<std::string>(LocalPort::open(path_.string())); }
  FileDescriptor client() const {
    FileDescriptor fd(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path_.c_str());
    EXPECT_EQ(connect(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    return fd;
  }
  static void give(const FileDescriptor& fd, const can::Frame& f) {
    const auto p = can::to_packet(f);
    EXPECT_EQ(send(fd.get(), p.data(), p.size(), 0), 16);
  }
  static std::optional<can::Frame> take(const FileDescriptor& fd) {
    can::LocalPacket p{};
    return recv(fd.get(), p.data(), p.size(), 0) == 16 ? can::from_packet(p) : std::nullopt;
  }

  std::filesystem::path folder_, path_;
  std::vector<Received> frames_;
  std::vector<int> left_;
};

TEST_F(LocalPortTest, FramesGoBothWaysAndNotBackToTheirSender) {
  const auto port = open();
  const FileDescriptor a = client(), b = client();
  give(a, can::sync_frame());
  port->receive(frames_, left_);
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_EQ(port->clients(), 2);
  port->send(frames_[0].frame, frames_[0].client);
  EXPECT_FALSE(take(a));
  EXPECT_EQ(take(b), can::sync_frame());
}

TEST_F(LocalPortTest, AClientThatLeavesIsNoticed) {
  const auto port = open();
  FileDescriptor a = client();
  give(a, can::sync_frame());
  a.reset();
  port->receive(frames_, left_);
  EXPECT_EQ(frames_.size(), 1U);  // what it sent before leaving is received
  EXPECT_EQ(left_.size(), 1U);
  EXPECT_EQ(port->clients(), 0);
  port->send(can::sync_frame(), -1);
}

TEST_F(LocalPortTest, APacketThatIsNoFrameIsIgnored) {
  const auto port = open();
  const FileDescriptor a = client();
  EXPECT_EQ(send(a.get(), "hello", 5, 0), 5);
  port->receive(frames_, left_);
  EXPECT_TRUE(frames_.empty());
  EXPECT_EQ(port->clients(), 1);
}

TEST_F(LocalPortTest, AClientThatDoesNotReadLosesFramesAndDelaysNobody) {
  const auto port = open();
  const FileDescriptor deaf = client();
  port->receive(frames_, left_);
  for (int i = 0; i < 100000 && port->dropped_frames() == 0; ++i) port->send(can::sync_frame(), -1);
  EXPECT_GT(port->dropped_frames(), 0);
}

TEST_F(LocalPortTest, ALiveSocketIsRefusedAndALeftOverOneReplaced) {
  auto port = open();
  EXPECT_NE(refusal().find("in use"), std::string::npos);
  const auto held = folder_ / "held";
  std::filesystem::create_hard_link(path_, held);  // keeps the socket file after the port is closed, as after a SIGKILL
  port.reset();
  EXPECT_FALSE(std::filesystem::exists(path_)) << "a port removes its socket";
  std::filesystem::rename(held, path_);
  port = open();
  EXPECT_NE(port, nullptr);
}

TEST_F(LocalPortTest, AFileInTheWayOrAMissingFolderIsRefusedInOneLine) {
  std::ofstream(path_) << "precious";
  EXPECT_NE(refusal().find("is a file"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path_));
  path_ = folder_ / "nowhere" / "bus";
  EXPECT_EQ(refusal().find('\n'), std::string::npos);
}

}  // namespace
}  // namespace ligature::sim
