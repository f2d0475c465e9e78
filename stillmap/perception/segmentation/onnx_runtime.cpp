// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/onnx_runtime.hpp"

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/perception/segmentation/model_folder.hpp"

#if STILLMAP_WITH_ONNXRUNTIME
#include <algorithm>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include <dlfcn.h>

#define ORT_API_MANUAL_INIT
#include <onnxruntime_cxx_api.h>
#endif

namespace stillmap {

#if STILLMAP_WITH_ONNXRUNTIME
namespace {

// This file uses version 1.17 of the interface, so that every later library works.
constexpr std::uint32_t kApiVersion = 17;

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

void* open_library() {
  std::string failures;
  for (const std::filesystem::path& path : onnx_runtime_libraries()) {
    void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library != nullptr) return library;
    // NOLINTNEXTLINE(concurrency-mt-unsafe): glibc keeps the message for each thread
    failures += failures.empty() ? std::string(dlerror()) : "; " + std::string(dlerror());
  }
  throw Error(
      "ONNX Runtime cannot be loaded: run tools/fetch_models, or name libonnxruntime.so.1 in "
      "STILLMAP_ONNXRUNTIME ({})",
      one_line(failures));
}

const OrtApi* load_api() {
  void* const library = open_library();
  using GetApiBase = const OrtApiBase* (*)();
  GetApiBase get_api_base = nullptr;
  void* const symbol = dlsym(library, "OrtGetApiBase");
  static_assert(sizeof(symbol) == sizeof(get_api_base));
  std::memcpy(&get_api_base, &symbol, sizeof(symbol));
  if (get_api_base == nullptr) throw Error("libonnxruntime has no OrtGetApiBase");
  const OrtApi* const api = get_api_base()->GetApi(kApiVersion);
  if (api == nullptr) {
    throw Error("ONNX Runtime {} is too old, expected 1.{} or later: run tools/fetch_models",
                get_api_base()->GetVersionString(),
                kApiVersion);
  }
  return api;
}

// Loaded once and never unloaded, because the C++ interface keeps a pointer to it.
const Ort::Env& environment() {
  static const Ort::Env env = [] {
    Ort::InitApi(load_api());
    Ort::Env made(ORT_LOGGING_LEVEL_ERROR, "stillmap");
    made.DisableTelemetryEvents();
    return made;
  }();
  return env;
}

Ort::SessionOptions session_options(const OnnxOptions& options) {
  Ort::SessionOptions session;
  session.SetIntraOpNumThreads(options.threads);
  session.SetInterOpNumThreads(1);
  session.SetExecutionMode(ORT_SEQUENTIAL);
  session.SetGraphOptimizationLevel(ORT_ENABLE_ALL);
  // Waiting threads must not spin: the rest of the program needs the cores.
  session.AddConfigEntry("session.intra_op.allow_spinning", "0");
  return session;
}

template <class Number>
float to_float(Number number) {
  if constexpr (std::is_same_v<Number, Ort::Float16_t>) {
    return number.ToFloat();
  } else {
    return static_cast<float>(number);
  }
}

template <class Number>
std::vector<float> to_floats(const Ort::Value& value, std::size_t count) {
  const Number* const first = value.GetTensorData<Number>();
  std::vector<float> floats(count);
  std::transform(first, first + count, floats.begin(), to_float<Number>);
  return floats;
}

Tensor to_tensor(const Ort::Value& value, const std::string& name) {
  if (!value.IsTensor()) throw Error("output '{}' is no tensor", name);
  const Ort::TensorTypeAndShapeInfo info = value.GetTensorTypeAndShapeInfo();
  const TensorShape shape = info.GetShape();
  const std::int64_t count = element_count(shape);
  if (count < 0) throw Error("output '{}' is as large as {}", name, shape_text(shape));
  const auto size = static_cast<std::size_t>(count);
  switch (info.GetElementType()) {
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT:
      return {shape, to_floats<float>(value, size)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT16:
      return {shape, to_floats<Ort::Float16_t>(value, size)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT64:
      return {shape, to_floats<std::int64_t>(value, size)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT32:
      return {shape, to_floats<std::int32_t>(value, size)};
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_UINT8:
      return {shape, to_floats<std::uint8_t>(value, size)};
    default:
      throw Error("output '{}' holds neither floats nor integers", name);
  }
}

std::vector<const char*> pointers(const std::vector<NamedShape>& names) {
  std::vector<const char*> all;
  for (const NamedShape& named : names) all.push_back(named.name.c_str());
  return all;
}

class OnnxNetwork : public Network {
 public:
  OnnxNetwork(std::filesystem::path file, const OnnxOptions& options)
      : file_(std::move(file)),
        session_(std::make_unique<Ort::Session>(
            environment(), file_.c_str(), session_options(options))) {
    read_signature();
  }

  [[nodiscard]] const NetworkSignature& signature() const override { return signature_; }

  [[nodiscard]] std::vector<Tensor> run(const Tensor& input) const override {
    STILLMAP_CHECK(element_count(input.shape) == std::ssize(input.values));
    try {
      return checked_run(input);
    } catch (const Ort::Exception& error) {
      throw Error("{}: {}", file_.string(), one_line(error.what()));
    } catch (const Error& error) {
      throw Error("{}: {}", file_.string(), error.what());
    }
  }

 private:
  void read_signature() {
    const Ort::AllocatorWithDefaultOptions allocator;
    for (std::size_t i = 0; i < session_->GetInputCount(); ++i) {
      signature_.inputs.push_back({session_->GetInputNameAllocated(i, allocator).get(),
                                   shape_of(session_->GetInputTypeInfo(i))});
    }
    for (std::size_t i = 0; i < session_->GetOutputCount(); ++i) {
      signature_.outputs.push_back({session_->GetOutputNameAllocated(i, allocator).get(),
                                    shape_of(session_->GetOutputTypeInfo(i))});
    }
    signature_.class_names = metadata("names");
    signature_.task = metadata("task");
    check_input();
  }

  // Empty if the network has no such entry.
  [[nodiscard]] std::string metadata(const char* key) const {
    const Ort::AllocatorWithDefaultOptions allocator;
    const Ort::AllocatedStringPtr text =
        session_->GetModelMetadata().LookupCustomMetadataMapAllocated(key, allocator);
    return text == nullptr ? std::string() : std::string(text.get());
  }

  static TensorShape shape_of(const Ort::TypeInfo& info) {
    if (info.GetONNXType() != ONNX_TYPE_TENSOR) return {};
    return info.GetTensorTypeAndShapeInfo().GetShape();
  }

  void check_input() {
    const bool is_one_tensor = signature_.inputs.size() == 1 && !signature_.inputs[0].shape.empty();
    if (is_one_tensor) {
      input_type_ = session_->GetInputTypeInfo(0).GetTensorTypeAndShapeInfo().GetElementType();
    }
    if (!is_one_tensor || (input_type_ != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT &&
                           input_type_ != ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT16)) {
      throw Error("{}: expected a network with one image of floats as its input", file_.string());
    }
  }

  [[nodiscard]] std::vector<Tensor> checked_run(const Tensor& input) const {
    if (input_type_ == ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT16) {
      std::vector<Ort::Float16_t> halves;
      halves.reserve(input.values.size());
      for (const float value : input.values) halves.emplace_back(value);
      return run_session(halves, input.shape);
    }
    // The interface takes input by a non-const pointer, so it gets a copy.
    std::vector<float> values = input.values;
    return run_session(values, input.shape);
  }

  template <class Number>
  [[nodiscard]] std::vector<Tensor> run_session(std::vector<Number>& input,
                                                const TensorShape& shape) const {
    const Ort::MemoryInfo memory = Ort::MemoryInfo::CreateCpu(OrtArenaAllocator, OrtMemTypeDefault);
    const Ort::Value value = Ort::Value::CreateTensor<Number>(
        memory, input.data(), input.size(), shape.data(), shape.size());
    const std::vector<const char*> inputs = pointers(signature_.inputs);
    const std::vector<const char*> outputs = pointers(signature_.outputs);
    const std::vector<Ort::Value> results = session_->Run(
        Ort::RunOptions(nullptr), inputs.data(), &value, 1, outputs.data(), outputs.size());
    std::vector<Tensor> tensors;
    for (std::size_t i = 0; i < results.size(); ++i) {
      tensors.push_back(to_tensor(results[i], signature_.outputs[i].name));
    }
    return tensors;
  }

  std::filesystem::path file_;
  std::unique_ptr<Ort::Session> session_;
  NetworkSignature signature_;
  ONNXTensorElementDataType input_type_ = ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT;
};

}  // namespace

bool built_with_onnx_runtime() {
  return true;
}

std::unique_ptr<Network> open_onnx_network(const std::filesystem::path& file,
                                           const OnnxOptions& options) {
  STILLMAP_CHECK(options.threads > 0);
  if (!path_exists(file)) throw Error("{}: there is no such network", file.string());
  (void)environment();
  try {
    return std::make_unique<OnnxNetwork>(file, options);
  } catch (const Ort::Exception& error) {
    throw Error("{}: expected an ONNX network ({})", file.string(), one_line(error.what()));
  }
}

#else

bool built_with_onnx_runtime() {
  return false;
}

std::unique_ptr<Network> open_onnx_network(const std::filesystem::path& file, const OnnxOptions&) {
  throw Error(
      "{}: this program was built without ONNX Runtime: run tools/fetch_models, then build again",
      file.string());
}

#endif

}  // namespace stillmap
