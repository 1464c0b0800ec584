#include "models/checkpoint.hpp"

#include <sstream>
#include <system_error>
#include <type_traits>

#include <torch/serialize.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

using TensorDict = c10::Dict<std::string, torch::Tensor>;
using AdamStates = std::decay_t<decltype(std::declval<torch::optim::Adam&>().state())>;
constexpr const char* kVersionKey = "alight_checkpoint_version";

/// How Adam files a parameter's state: by the address, as text in LibTorch 1, as a pointer in LibTorch 2.
template <class Key>
Key state_key(const torch::Tensor& parameter) {
  void* const address = parameter.unsafeGetTensorImpl();
  if constexpr (std::is_same_v<Key, std::string>) {
    std::ostringstream text;
    text << parameter.unsafeGetTensorImpl();
    return text.str();
  } else {
    return address;
  }
}

TensorDict named_tensors(DepthCompletionNet net) {
  TensorDict tensors;
  for (const auto& item : net->named_parameters())
    tensors.insert(item.key(), item.value().detach().cpu().contiguous());
  for (const auto& item : net->named_buffers())
    tensors.insert(item.key(), item.value().detach().cpu().contiguous());
  return tensors;
}

/// Adam's moments under the names of the parameters. torch::save would file them by memory address: another
/// process could not tell which is whose, and two equal runs would write different bytes.
TensorDict adam_state(DepthCompletionNet net, const torch::optim::Adam& adam) {
  TensorDict tensors;
  for (const auto& item : net->named_parameters()) {
    const auto found = adam.state().find(state_key<AdamStates::key_type>(item.value()));
    if (found == adam.state().end()) continue;
    const auto& state = static_cast<const torch::optim::AdamParamState&>(*found->second);
    tensors.insert(item.key() + ".exp_avg", state.exp_avg().cpu().contiguous());
    tensors.insert(item.key() + ".exp_avg_sq", state.exp_avg_sq().cpu().contiguous());
    tensors.insert(item.key() + ".step", torch::tensor(state.step(), torch::kInt64));
  }
  return tensors;
}

std::string shape(const torch::Tensor& tensor) {
  std::ostringstream text;
  text << tensor.sizes();
  return text.str();
}

/// An open checkpoint; turns torch's exceptions into what the user can act on.
class Reader {
 public:
  explicit Reader(const fs::path& path) : path_(path.string()) {
    std::error_code code;
    if (!fs::is_regular_file(path, code)) fail("no such file; alight-train writes last.pt and best.pt");
    try {
      archive_.load_from(path_, torch::kCPU);
    } catch (const c10::Error&) {
      fail("not a checkpoint of Alight, or damaged");
    }
    const std::int64_t version = read(kVersionKey).toInt();
    if (version != kCheckpointVersion) {
      const bool newer = version > kCheckpointVersion;
      fail("checkpoint version " + std::to_string(version) + " is " + (newer ? "newer" : "older") +
           " than this program's " + std::to_string(kCheckpointVersion) +
           (newer ? "; update Alight" : "; train the network again"));
    }
  }

  c10::IValue read(const std::string& key) {
    c10::IValue value;
    bool found = false;
    try {
      found = archive_.try_read(key, value);
    } catch (const c10::Error&) {
      found = false;
    }
    if (!found) fail("not a checkpoint of Alight (it has no \"" + key + "\")");
    return value;
  }

  TensorDict tensors(const std::string& key) {
    const c10::IValue value = read(key);
    if (!value.isGenericDict()) fail("not a checkpoint of Alight (\"" + key + "\" holds no tensors)");
    return c10::impl::toTypedDict<std::string, torch::Tensor>(value.toGenericDict());
  }

  CheckpointInfo info() {
    CheckpointInfo info;
    info.epoch = read("epoch").toInt();
    info.step = read("step").toInt();
    info.train_config = read("train_config").toStringRef();
    info.epoch_step = read("epoch_step").toInt();
    info.epoch_losses = read("epoch_losses").toDoubleVector();
    info.best_score = read("best_score").toDouble();
    info.best_epoch = read("best_epoch").toInt();
    return info;
  }

  [[noreturn]] void fail(const std::string& what) const { throw DataError(path_ + ": " + what); }

 private:
  std::string path_;
  torch::serialize::InputArchive archive_;
};

/// Copies the file's tensor over `target`; complains about the first that is missing or shaped otherwise.
void assign(const Reader& reader, const TensorDict& file, const std::string& name, torch::Tensor target) {
  const auto found = file.find(name);
  if (found == file.end()) {
    reader.fail("another network: tensor " + name + " " + shape(target) +
                " is not in the file; use its model section");
  }
  const torch::Tensor source = found->value();
  if (source.sizes() != target.sizes()) {
    reader.fail("another network: tensor " + name + " is " + shape(source) + " in the file, " +
                shape(target) + " in this network; use the file's model section");
  }
  torch::NoGradGuard no_grad;
  target.copy_(source);
}

void write_archive(const fs::path& path, DepthCompletionNet net, const CheckpointInfo& info,
                   const TensorDict& weights, const TensorDict& training_weights, const TensorDict& adam) {
  torch::serialize::OutputArchive archive;
  archive.write(kVersionKey, c10::IValue(kCheckpointVersion));
  archive.write("model_config", c10::IValue(print_config(net->config())));
  archive.write("train_config", c10::IValue(info.train_config));
  archive.write("epoch", c10::IValue(info.epoch));
  archive.write("step", c10::IValue(info.step));
  archive.write("epoch_step", c10::IValue(info.epoch_step));
  archive.write("epoch_losses", c10::IValue(info.epoch_losses));
  archive.write("best_score", c10::IValue(info.best_score));
  archive.write("best_epoch", c10::IValue(info.best_epoch));
  archive.write("weights", c10::IValue(weights));
  archive.write("training_weights", c10::IValue(training_weights));
  archive.write("adam", c10::IValue(adam));
  // Through a stream, because a file's archive carries the file's name: equal networks are equal bytes.
  std::ostringstream bytes;
  archive.save_to(bytes);
  write_file_atomically(path, bytes.str());
}

void assign_weights(Reader& reader, const char* key, DepthCompletionNet net) {
  const TensorDict file = reader.tensors(key);
  for (const auto& item : net->named_parameters()) assign(reader, file, item.key(), item.value());
  for (const auto& item : net->named_buffers()) assign(reader, file, item.key(), item.value());
  const std::size_t expected = net->named_parameters().size() + net->named_buffers().size();
  if (file.size() != expected) {
    reader.fail("another network: " + std::to_string(file.size()) + " tensors in the file, " +
                std::to_string(expected) + " in this network; use the file's model section");
  }
}

/// The weights of the encoder's first layer; `file` may have fewer input channels.
void assign_first_convolution(const Reader& reader, const TensorDict& file, const std::string& name,
                              const torch::Tensor& target) {
  const auto found = file.find(name);
  torch::Tensor seen = target;
  if (found != file.end() && found->value().dim() == 4 && found->value().size(1) < target.size(1)) {
    seen = target.narrow(1, 0, found->value().size(1));
    torch::NoGradGuard no_grad;
    target.detach().zero_();
  }
  assign(reader, file, name, seen.detach());
}

void assign_adam(Reader& reader, DepthCompletionNet net, torch::optim::Adam& adam) {
  const TensorDict file = reader.tensors("adam");
  if (file.size() == 0) reader.fail("holds no training state; a run is resumed from its last.pt");
  for (const auto& item : net->named_parameters()) {
    if (!file.contains(item.key() + ".step")) continue;  // a parameter that never had a gradient
    auto state = std::make_unique<torch::optim::AdamParamState>();
    state->exp_avg(torch::zeros_like(item.value()));
    state->exp_avg_sq(torch::zeros_like(item.value()));
    assign(reader, file, item.key() + ".exp_avg", state->exp_avg());
    assign(reader, file, item.key() + ".exp_avg_sq", state->exp_avg_sq());
    state->step(file.at(item.key() + ".step").item<std::int64_t>());
    adam.state()[state_key<AdamStates::key_type>(item.value())] = std::move(state);
  }
}

}  // namespace

void save_checkpoint(const fs::path& path, DepthCompletionNet net, const CheckpointInfo& info,
                     const TrainingState& training) {
  const bool average = training.net && training.net.ptr() != net.ptr();
  write_archive(path, net, info, named_tensors(net), average ? named_tensors(training.net) : TensorDict(),
                training.adam != nullptr ? adam_state(training.net, *training.adam) : TensorDict());
}

void save_network(const fs::path& path, DepthCompletionNet net, const CheckpointInfo& info) {
  TensorDict weights;
  for (const auto& item : named_tensors(net)) {
    weights.insert(item.key(), item.value().dim() > 1 ? item.value().to(torch::kFloat16) : item.value());
  }
  write_archive(path, net, info, weights, TensorDict(), TensorDict());
}

LoadedNetwork load_network(const fs::path& path, torch::Device device) {
  Reader reader(path);
  LoadedNetwork loaded;
  try {
    loaded.config =
        parse_config<DepthCompletionConfig>(reader.read("model_config").toStringRef(), "model_config");
  } catch (const ConfigError& e) {
    reader.fail(std::string("its architecture is unknown to this program: ") + e.what());
  }
  loaded.net = DepthCompletionNet(loaded.config);
  assign_weights(reader, "weights", loaded.net);
  loaded.info = reader.info();
  loaded.net->to(device);
  loaded.net->eval();
  return loaded;
}

CheckpointInfo load_checkpoint(const fs::path& path, DepthCompletionNet net) {
  Reader reader(path);
  assign_weights(reader, "weights", net);
  return reader.info();
}

CheckpointInfo load_training(const fs::path& path, DepthCompletionNet net, const TrainingState& training) {
  Reader reader(path);
  assign_weights(reader, "weights", net);
  if (training.net.ptr() != net.ptr()) assign_weights(reader, "training_weights", training.net);
  assign_adam(reader, training.net, *training.adam);
  return reader.info();
}

void load_image_encoder(const fs::path& path, DepthCompletionNet net) {
  const std::string prefix = "image_encoder.";
  const auto in_encoder = [&](const std::string& name) { return name.rfind(prefix, 0) == 0; };
  Reader reader(path);
  const TensorDict file = reader.tensors("weights");
  const TensorDict targets = named_tensors(net);
  for (const auto& item : file) {
    if (in_encoder(item.key()) && !targets.contains(item.key())) {
      reader.fail("another image encoder: the network has no tensor " + item.key() +
                  "; compare stem and normalization in the model sections");
    }
  }
  const auto copy = [&](const std::string& name, const torch::Tensor& target) {
    if (!in_encoder(name)) return;
    if (name == prefix + "stem.conv.weight") return assign_first_convolution(reader, file, name, target);
    assign(reader, file, name, target);
  };
  for (const auto& item : net->named_parameters()) copy(item.key(), item.value());
  for (const auto& item : net->named_buffers()) copy(item.key(), item.value());
}

}  // namespace alight
