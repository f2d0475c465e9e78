// SPDX-License-Identifier: Apache-2.0
// Compares ways to recognise places: place_table [ROLE ROOM=FOLDER BEGIN_S END_S]...
// ROLE: train (the vocabulary), known (places in the index), unknown (queries of places that are
// not in it) or a name (queries). Prints a Markdown table.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>

#include <fmt/core.h>

#include "bench/place/designs.hpp"
#include "bench/place/views.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kGap = 8;

struct Material {
  std::vector<PlaceView> train, known, unknown;
  std::map<std::string, std::vector<PlaceView>> queries;
};

Material read_material(const std::vector<std::string>& words) {
  Material material;
  for (std::size_t i = 0; i + 3 < words.size(); i += 4) {
    const double begin = std::stod(words[i + 2]), end = std::stod(words[i + 3]);
    std::vector<PlaceView>& into = words[i] == "train"     ? material.train
                                   : words[i] == "known"   ? material.known
                                   : words[i] == "unknown" ? material.unknown
                                                           : material.queries[words[i]];
    for (PlaceView& view : read_views(words[i + 1], kGap)) {
      if (view.time_s >= begin && view.time_s < end) into.push_back(std::move(view));
    }
  }
  return material;
}

// The best place for a query, among those that are certainly the same or certainly different.
struct Answer {
  double score = 0;
  bool right = false;
};

struct Results {
  std::vector<Answer> answers;  // of queries with a right answer
  double milliseconds = 0;      // summed over all queries
};

// `least_deg`: views closer in angle are left out, to measure the cost of a change of view.
Results ask(const PlaceDesign& design,
            const std::vector<PlaceView>& known,
            const std::vector<PlaceView>& queries,
            double least_deg,
            bool any) {
  Results results;
  for (const PlaceView& query : queries) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<double> scores = design.scores(query.features->descriptors);
    results.milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    Answer best;
    bool has_same = false;
    for (std::size_t k = 0; k < known.size(); ++k) {
      const Relation how = relation(query, known[k]);
      if (how == Relation::kNeither) continue;
      if (how == Relation::kSame && angle_deg(query, known[k]) < least_deg) continue;
      has_same = has_same || how == Relation::kSame;
      if (scores[k] > best.score) best = {scores[k], how == Relation::kSame};
    }
    if (has_same || any) results.answers.push_back(best);
  }
  return results;
}

double highest_false(const std::vector<Answer>& answers) {
  double highest = 0;
  for (const Answer& answer : answers) {
    if (!answer.right) highest = std::max(highest, answer.score);
  }
  return highest;
}

double recall(const std::vector<Answer>& answers, double above) {
  const auto right = std::ranges::count_if(
      answers, [&](const Answer& answer) { return answer.right && answer.score > above; });
  return answers.empty() ? 0
                         : 100.0 * static_cast<double>(right) / static_cast<double>(answers.size());
}

void report(const NamedDesign& named, const Material& material) {
  const std::unique_ptr<PlaceDesign> design = named.make();
  for (const PlaceView& view : material.known) design->add(view.features->descriptors);
  const Results unknown = ask(*design, material.known, material.unknown, 0, true);
  double threshold = highest_false(unknown.answers), total_ms = unknown.milliseconds;
  std::size_t asked = material.unknown.size();
  std::vector<std::vector<Answer>> rows;
  for (const auto& [name, queries] : material.queries) {
    for (const double least_deg : {0.0, 15.0}) {
      const Results results = ask(*design, material.known, queries, least_deg, false);
      threshold = std::max(threshold, highest_false(results.answers));
      total_ms += results.milliseconds;
      asked += queries.size();
      rows.push_back(results.answers);
    }
  }
  std::string line = fmt::format("| {} |", named.name);
  for (const std::vector<Answer>& row : rows) {
    if (row.empty()) continue;
    line += fmt::format(" {:.0f} / {:.0f} |", recall(row, 0), recall(row, threshold));
  }
  fmt::print("{} {:.4f} | {:.2f} |\n", line, threshold, total_ms / static_cast<double>(asked));
  std::fflush(stdout);
}

std::vector<NamedDesign> all_designs(const Material& material) {
  std::vector<NamedDesign> designs;
  for (const int bits : {12, 16, 20}) {
    for (const int tables : {4, 8}) {
      designs.push_back({fmt::format("(a) hash words, {} x {} bits", tables, bits),
                         [=] { return hash_words(tables, bits); }});
    }
  }
  std::vector<Descriptor> training;
  for (const PlaceView& view : material.train) {
    training.insert(
        training.end(), view.features->descriptors.begin(), view.features->descriptors.end());
  }
  for (const std::size_t branching : {10U, 16U, 20U}) {
    if (training.empty()) break;
    const auto tree = train_vocabulary(training, branching);
    designs.push_back({fmt::format("(b) vocabulary, {}^3 words", branching),
                       [=] { return vocabulary_words(tree); }});
  }
  for (const PlaceOptions& o : {PlaceOptions{8, 16, 30, 1},
                                PlaceOptions{12, 16, 30, 1},
                                PlaceOptions{12, 16, 35, 1},
                                PlaceOptions{8, 20, 40, 1},
                                PlaceOptions{8, 20, 40, 4},
                                PlaceOptions{12, 20, 40, 1}}) {
    designs.push_back({fmt::format("(c) voting, {} x {} bits, {} apart, {} alike",
                                   o.keys,
                                   o.key_bits,
                                   o.max_distance,
                                   o.max_alike),
                       [=] { return place_index(o); }});
  }
  return designs;
}

int run(const std::vector<std::string>& words) {
  const Material material = read_material(words);
  fmt::print("{} known, {} unknown, {} for training\n| design |",
             material.known.size(),
             material.unknown.size(),
             material.train.size());
  for (const auto& [name, queries] : material.queries) {
    fmt::print(" {} ({}) |  from 15 deg |", name, queries.size());
  }
  fmt::print(" threshold | ms |\n");
  for (const NamedDesign& design : all_designs(material)) report(design, material);
  return 0;
}

}  // namespace
}  // namespace stillmap

int main(int argc, char** argv) {
  try {
    return stillmap::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "place_table: {}\n", error.what());
    return 2;
  }
}
