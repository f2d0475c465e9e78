// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/class_names.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "stillmap/core/ascii_lower.hpp"

namespace stillmap {
namespace {

constexpr std::array<std::string_view, 80> kCoco = {
    "person",        "bicycle",      "car",
    "motorcycle",    "airplane",     "bus",
    "train",         "truck",        "boat",
    "traffic light", "fire hydrant", "stop sign",
    "parking meter", "bench",        "bird",
    "cat",           "dog",          "horse",
    "sheep",         "cow",          "elephant",
    "bear",          "zebra",        "giraffe",
    "backpack",      "umbrella",     "handbag",
    "tie",           "suitcase",     "frisbee",
    "skis",          "snowboard",    "sports ball",
    "kite",          "baseball bat", "baseball glove",
    "skateboard",    "surfboard",    "tennis racket",
    "bottle",        "wine glass",   "cup",
    "fork",          "knife",        "spoon",
    "bowl",          "banana",       "apple",
    "sandwich",      "orange",       "broccoli",
    "carrot",        "hot dog",      "pizza",
    "donut",         "cake",         "chair",
    "couch",         "potted plant", "bed",
    "dining table",  "toilet",       "tv",
    "laptop",        "mouse",        "remote",
    "keyboard",      "cell phone",   "microwave",
    "oven",          "toaster",      "sink",
    "refrigerator",  "book",         "clock",
    "vase",          "scissors",     "teddy bear",
    "hair drier",    "toothbrush"};

struct Synonyms {
  std::string_view coco;
  std::string_view names;  // separated by blanks
};

// Names of VOC, other data sets and common custom networks, in the form of folded().
constexpr std::array<Synonyms, 25> kSynonyms = {{
    {"person",
     "persons people pedestrian pedestrians human humans man men woman women boy girl child "
     "children kid baby adult worker rider cyclist player"},
    {"airplane", "aeroplane plane aircraft"},
    {"backpack", "rucksack"},
    {"bicycle", "bike"},
    {"book", "books"},
    {"car", "automobile"},
    {"cat", "kitten"},
    {"cell phone", "phone mobilephone smartphone"},
    {"chair", "armchair officechair swivelchair"},
    {"couch", "sofa settee"},
    {"cup", "mug"},
    {"dining table", "table"},
    {"dog", "puppy"},
    {"donut", "doughnut"},
    {"hair drier", "hairdryer"},
    {"handbag", "purse"},
    {"keyboard", "computerkeyboard"},
    {"laptop", "laptopcomputer"},
    {"motorcycle", "motorbike"},
    {"mouse", "computermouse"},
    {"potted plant", "plant houseplant"},
    {"refrigerator", "fridge"},
    {"remote", "remotecontrol"},
    {"sports ball", "ball"},
    {"tv", "tvmonitor monitor television"},
}};

std::string folded(std::string_view name) {
  std::string letters;
  for (const char original : name) {
    const char c = ascii_lower(original);
    const bool other_script = static_cast<unsigned char>(c) >= 0x80;
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || other_script) letters += c;
  }
  return letters;
}

// The bytes of the printable character that a text of UTF-8 begins with; 0 if there is none.
std::size_t character_size(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  constexpr std::array<unsigned, 5> kLeast = {0, 0, 0xA0, 0x800, 0x10000};  // A0: after controls
  unsigned code = first & (0x7FU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool valid = first >= 0xC2 && first <= 0xF4 && code >= kLeast.at(size) &&
                     code <= 0x10FFFF && !is_surrogate;
  return valid ? size : 0;
}

using NameTable = std::map<std::string, std::string_view, std::less<>>;

// The COCO class of each of its names, folded.
NameTable make_name_table() {
  NameTable table;
  for (const std::string_view name : kCoco) table.emplace(folded(name), name);
  for (const Synonyms& synonyms : kSynonyms) {
    for (std::string_view rest = synonyms.names; !rest.empty();) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      table.emplace(rest.substr(0, end), synonyms.coco);
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return table;
}

}  // namespace

std::span<const std::string_view> coco_class_names() {
  return kCoco;
}

bool is_coco_class(std::string_view name) {
  return std::ranges::find(kCoco, name) != kCoco.end();
}

bool is_class_name(std::string_view text) {
  if (text.empty() || text.size() > kMaxClassNameBytes) return false;
  while (!text.empty()) {
    const std::size_t size = character_size(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

std::string usable_class_name(std::string_view text) {
  std::string name;
  while (!text.empty()) {
    const std::size_t size = character_size(text);
    const std::string_view character = size > 0 ? text.substr(0, size) : "?";
    if (name.size() + character.size() > kMaxClassNameBytes) break;
    name += character;
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return name.empty() ? "?" : name;
}

std::string coco_name(std::string_view name) {
  static const NameTable table = make_name_table();
  const auto found = table.find(folded(name));
  return std::string(found == table.end() ? name : found->second);
}

bool is_same_name(std::string_view a, std::string_view b) {
  const std::string letters = folded(a);
  return letters.empty() ? a == b : letters == folded(b);
}

}  // namespace stillmap
