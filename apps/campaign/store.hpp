#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/campaign/factor.hpp"
#include "apps/campaign/trial_result.hpp"
#include "apps/campaign/trial_setup.hpp"

namespace hopscotch::apps::campaign {

/// What the rows of a store belong to; rows of different campaigns never mix.
struct StoreIdentity {
  std::string identity;  ///< `TrialMaker::identity`.
  std::string program;   ///< Version and revision.
  std::string pairing;   ///< Fingerprint of `CampaignSpec::pairing`.
  std::string name;
  std::string source;  ///< Text of the campaign file.
  std::int64_t cells = 1;
  std::vector<Factor> factors;  ///< In the order of `TrialResult::values`.
};
[[nodiscard]] StoreIdentity identity_of(const TrialMaker& maker);

/// The results of a campaign: one row a trial in an SQLite file. A row is there whole or not at
/// all, whatever is killed when; a trial has one row, whoever delivers it.
class Store {
 public:
  /// Opens or begins `file`.
  /// @throws core::ConfigError if it holds another campaign or rows of another program version,
  ///         saying which; std::runtime_error if it is no such store or the disk refuses.
  Store(const std::filesystem::path& file, const StoreIdentity& identity);
  /// Opens a store to read whatever campaign it holds.
  explicit Store(const std::filesystem::path& file);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  [[nodiscard]] const StoreIdentity& identity() const { return identity_; }

  /// Adds a row, durable when it returns; a trial that is there already stays as it is.
  /// @return whether it was new.
  /// @throws std::runtime_error if the disk refuses; what was added before stays.
  bool add(const TrialResult& result);

  /// Rows in the order of their index. Paths are read only if asked for.
  enum class Paths : std::uint8_t { with, without };
  void for_each(Paths paths, const std::function<void(const TrialResult&)>& visit) const;

  /// Only rows of the first `cells` cells that have a path.
  void for_each_path(std::int64_t cells,
                     const std::function<void(const TrialResult&)>& visit) const;

  [[nodiscard]] std::optional<TrialResult> find(std::int64_t index) const;

  /// Time that computing took in all sessions together [s]; kept beside the rows.
  [[nodiscard]] double elapsed() const;
  void add_elapsed(double seconds);
  /// A word about the store, e.g. which engine filled it.
  [[nodiscard]] std::string note(const std::string& key) const;
  void set_note(const std::string& key, const std::string& value);

 private:
  struct Database;
  void create();
  void read_identity();
  void require_same(const StoreIdentity& wanted) const;
  void prepare_insert();

  std::filesystem::path file_;
  StoreIdentity identity_;
  std::unique_ptr<Database> database_;
};

/// Adds all rows of another store of the same campaign. @return how many were new.
/// @throws core::ConfigError if it is of another campaign or program version.
std::int64_t merge(const std::filesystem::path& from, Store& into);

}  // namespace hopscotch::apps::campaign
