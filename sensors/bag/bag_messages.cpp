#include "sensors/bag/bag_messages.hpp"

#include <map>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <spdlog/spdlog.h>

#include "sensors/bag/bag_access.hpp"
#include "sensors/bag/bag_check.hpp"

namespace alight {
namespace fs = std::filesystem;

/// Where the messages come from: rosbag, or a bag that rosbag does not open.
class BagMessages::Source {
 public:
  virtual ~Source() = default;
  virtual const std::vector<BagConnection>& connections() const = 0;
  virtual std::uint64_t lost_bytes() const { return 0; }
  virtual std::int64_t select(const std::set<std::string>& topics) = 0;
  virtual std::int64_t begin_ns() const = 0;
  virtual std::int64_t end_ns() const = 0;
  virtual std::optional<BagMessage> next() = 0;
};

namespace {

std::int64_t nanoseconds(const ros::Time& time) { return static_cast<std::int64_t>(time.toNSec()); }

class IndexedSource : public BagMessages::Source {
 public:
  explicit IndexedSource(const fs::path& path) {
    bag_.open(path.string(),
              rosbag::bagmode::Read);  // its constructor would leak what it had read of a damaged bag
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* c : all.getConnections()) {
      if (index_.emplace(Key{c->topic, c->md5sum}, connections_.size()).second)
        connections_.push_back({c->topic, c->datatype, c->md5sum, c->msg_def});
    }
  }

  const std::vector<BagConnection>& connections() const override { return connections_; }

  std::int64_t select(const std::set<std::string>& topics) override {
    view_ = std::make_unique<rosbag::View>(
        bag_, [&](const rosbag::ConnectionInfo* connection) { return topics.count(connection->topic) != 0; });
    at_ = view_->begin();
    return view_->size();
  }

  std::int64_t begin_ns() const override {
    return view_->size() > 0 ? nanoseconds(view_->getBeginTime()) : 0;
  }
  std::int64_t end_ns() const override { return view_->size() > 0 ? nanoseconds(view_->getEndTime()) : 0; }

  std::optional<BagMessage> next() override {
    if (at_ == view_->end()) return std::nullopt;
    const rosbag::MessageInstance& message = *at_;
    sink_.bytes.clear();
    message.write(sink_);
    const std::size_t index = index_.at({message.getTopic(), message.getMD5Sum()});
    const RawMessage raw{sink_.bytes.data(), sink_.bytes.size(), nanoseconds(message.getTime())};
    ++at_;
    return BagMessage{&connections_[index], raw};
  }

 private:
  using Key = std::pair<std::string, std::string>;  // topic, checksum

  rosbag::Bag bag_;
  std::vector<BagConnection> connections_;  // one of several publishers of a topic
  std::map<Key, std::size_t> index_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator at_;
  ByteSink sink_;
};

class SalvageSource : public BagMessages::Source {
 public:
  explicit SalvageSource(const fs::path& path) : salvage_(path) {
    for (const auto& [id, connection] : salvage_.connections()) connections_.push_back(connection);
    if (salvage_.lost_bytes() == 0) {
      spdlog::warn("{}: has no index (its recorder was killed); every message in it is read", path.string());
    } else {
      spdlog::warn("{}: has no index (its recorder was killed); its last {} bytes cannot be read ({})",
                   path.string(), salvage_.lost_bytes(), salvage_.lost_reason());
    }
  }

  const std::vector<BagConnection>& connections() const override { return connections_; }
  std::uint64_t lost_bytes() const override { return salvage_.lost_bytes(); }

  std::int64_t select(const std::set<std::string>& topics) override {
    selected_.clear();
    for (const BagSalvage::Message& message : salvage_.messages()) {
      if (topics.count(salvage_.connection(message).topic) != 0) selected_.push_back(message);
    }
    at_ = 0;
    return static_cast<std::int64_t>(selected_.size());
  }

  std::int64_t begin_ns() const override { return selected_.empty() ? 0 : selected_.front().receive_ns; }
  std::int64_t end_ns() const override { return selected_.empty() ? 0 : selected_.back().receive_ns; }

  std::optional<BagMessage> next() override {
    if (at_ == selected_.size()) return std::nullopt;
    const BagSalvage::Message& message = selected_[at_++];
    const std::string_view data = salvage_.data(message);
    return BagMessage{&salvage_.connection(message),
                      {reinterpret_cast<const std::uint8_t*>(data.data()), data.size(), message.receive_ns}};
  }

 private:
  BagSalvage salvage_;
  std::vector<BagConnection> connections_;
  std::vector<BagSalvage::Message> selected_;
  std::size_t at_ = 0;
};

std::set<std::string> topics_of(const std::vector<BagConnection>& connections) {
  std::set<std::string> topics;
  for (const BagConnection& connection : connections) topics.insert(connection.topic);
  return topics;
}

}  // namespace

BagMessages::BagMessages(const fs::path& path) : path_(path) {
  require_file(path);
  with_bag_errors(path, [&] {
    if (check_bag_structure(path)) {
      source_ = std::make_unique<IndexedSource>(path);
    } else {
      source_ = std::make_unique<SalvageSource>(path);
    }
    select_all();
  });
}
BagMessages::~BagMessages() = default;
BagMessages::BagMessages(BagMessages&&) noexcept = default;
BagMessages& BagMessages::operator=(BagMessages&&) noexcept = default;

const std::vector<BagConnection>& BagMessages::connections() const { return source_->connections(); }
std::uint64_t BagMessages::lost_bytes() const { return source_->lost_bytes(); }
std::int64_t BagMessages::count(const std::string& topic) { return select({topic}); }
std::int64_t BagMessages::begin_ns() const { return source_->begin_ns(); }
std::int64_t BagMessages::end_ns() const { return source_->end_ns(); }

std::int64_t BagMessages::select(const std::set<std::string>& topics) {
  return with_bag_errors(path_, [&] { return source_->select(topics); });
}

std::int64_t BagMessages::select_all() { return select(topics_of(connections())); }

std::optional<BagMessage> BagMessages::next() {
  return with_bag_errors(path_, [&] { return source_->next(); });
}

}  // namespace alight
