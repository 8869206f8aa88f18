#include "apps/campaign/store.hpp"

#include <sqlite3.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "apps/installation.hpp"
#include "core/config_reader.hpp"

namespace hopscotch::apps::campaign {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSchema = "hopscotch.campaign.store/1";
constexpr int kBusyMs = 10'000;       // another process may read the store meanwhile
constexpr int kLastFixedColumn = 10;  // "landed"

std::string quoted(const std::string& name) {
  return "\"" + name + "\"";
}

/// Columns of the table of trials after the fixed ones: metrics, factors, wall time, path.
std::vector<std::string> number_columns(const StoreIdentity& identity) {
  std::vector<std::string> columns;
  for (const Metric& metric : kMetrics) columns.emplace_back(metric.name);
  for (const Factor& factor : identity.factors) columns.push_back("vary." + factor.name);
  columns.emplace_back("wall_s");
  return columns;
}

std::string factors_text(const std::vector<Factor>& factors) {
  nlohmann::json list = nlohmann::json::array();
  for (const Factor& factor : factors) {
    list.push_back({{"name", factor.name},
                    {"kind", static_cast<int>(factor.kind)},
                    {"lowest", factor.lowest},
                    {"highest", factor.highest},
                    {"step", factor.step},
                    {"values", factor.values},
                    {"labels", factor.labels},
                    {"words", factor.words}});
  }
  return list.dump();
}

std::vector<Factor> factors_from(const std::string& text) {
  std::vector<Factor> factors;
  for (const nlohmann::json& json : nlohmann::json::parse(text)) {
    Factor factor;
    json.at("name").get_to(factor.name);
    factor.kind = static_cast<Factor::Kind>(json.at("kind").get<int>());
    json.at("lowest").get_to(factor.lowest);
    json.at("highest").get_to(factor.highest);
    json.at("step").get_to(factor.step);
    json.at("values").get_to(factor.values);
    json.at("labels").get_to(factor.labels);
    json.at("words").get_to(factor.words);
    factors.push_back(factor);
  }
  return factors;
}

}  // namespace

StoreIdentity identity_of(const TrialMaker& maker) {
  const CampaignSpec& spec = maker.spec();
  return {.identity = maker.identity(),
          .program = std::string(program_version()),
          .pairing = fingerprint(spec.pairing()),
          .name = spec.name,
          .source = spec.source,
          .cells = spec.cells(),
          .factors = spec.factors};
}

/// The connection and its statements; throws with SQLite's words.
struct Store::Database {
  explicit Database(const fs::path& path) : file(path) {
    if (sqlite3_open(path.c_str(), &handle) != SQLITE_OK) fail();
    sqlite3_busy_timeout(handle, kBusyMs);
    execute("PRAGMA journal_mode=WAL");
    execute("PRAGMA synchronous=NORMAL");
  }
  ~Database() {
    sqlite3_finalize(insert);
    sqlite3_close(handle);
  }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  [[noreturn]] void fail() const {
    throw std::runtime_error(file.string() + ": " + sqlite3_errmsg(handle));
  }
  void execute(const std::string& sql) const {
    if (sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }

  fs::path file;
  sqlite3* handle = nullptr;
  sqlite3_stmt* insert = nullptr;
};

namespace {

/// One prepared statement.
class Statement {
 public:
  Statement(sqlite3* handle, const std::string& sql) : handle_(handle) {
    if (sqlite3_prepare_v2(handle, sql.c_str(), -1, &statement_, nullptr) != SQLITE_OK) fail();
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int column, const std::string& text) {
    sqlite3_bind_text(statement_, column, text.data(), static_cast<int>(text.size()),
                      SQLITE_TRANSIENT);
  }
  void bind(int column, std::int64_t value) { sqlite3_bind_int64(statement_, column, value); }

  /// The next row is there.
  bool step() {
    const int status = sqlite3_step(statement_);
    if (status != SQLITE_ROW && status != SQLITE_DONE) fail();
    return status == SQLITE_ROW;
  }
  [[nodiscard]] std::string text(int column) const {
    const void* bytes = sqlite3_column_blob(statement_, column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), size);
  }
  [[nodiscard]] std::int64_t integer(int column) const {
    return sqlite3_column_int64(statement_, column);
  }
  [[nodiscard]] double number(int column) const {
    const bool empty = sqlite3_column_type(statement_, column) == SQLITE_NULL;
    return empty ? core::kNaN : sqlite3_column_double(statement_, column);
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(std::string("the campaign's store: ") + sqlite3_errmsg(handle_));
  }
  sqlite3* handle_;
  sqlite3_stmt* statement_ = nullptr;
};

TrialResult row_of(const Statement& row, const StoreIdentity& identity, Store::Paths paths) {
  TrialResult result;
  result.index = row.integer(0);
  result.seed = static_cast<std::uint64_t>(row.integer(3));
  result.outcome = row.text(5);
  result.truth_outcome = row.text(6);
  result.cause = row.text(7);
  result.sentence = row.text(8);
  result.jumps = static_cast<int>(row.integer(9));
  result.landed = static_cast<int>(row.integer(kLastFixedColumn));
  int column = kLastFixedColumn + 1;
  for (const Metric& metric : kMetrics) result.*metric.value = row.number(column++);
  for (std::size_t i = 0; i < identity.factors.size(); ++i) {
    result.values.push_back(row.number(column++));
  }
  result.wall = row.number(column++);
  if (paths == Store::Paths::with) {
    const std::string bytes = row.text(column);
    result.path.resize(bytes.size() / sizeof(result.path[0]));
    std::copy(
        bytes.begin(),
        bytes.begin() + static_cast<std::ptrdiff_t>(result.path.size() * sizeof(result.path[0])),
        reinterpret_cast<char*>(result.path.data()));
  }
  return result;
}

}  // namespace

Store::Store(const fs::path& file, const StoreIdentity& identity)
    : file_(file), identity_(identity) {
  const bool begun = fs::exists(file);
  database_ = std::make_unique<Database>(file);
  if (!begun) {
    create();
  } else {
    read_identity();
    require_same(identity);
  }
  prepare_insert();
}

Store::Store(const fs::path& file) : file_(file) {
  if (!fs::is_regular_file(file)) {
    throw core::ConfigError(file.string() + ": no such store of a campaign");
  }
  database_ = std::make_unique<Database>(file);
  read_identity();
  prepare_insert();
}

Store::~Store() = default;

void Store::create() {
  std::string columns;
  for (const std::string& name : number_columns(identity_)) columns += quoted(name) + " REAL, ";
  database_->execute("BEGIN IMMEDIATE");
  database_->execute("CREATE TABLE campaign (key TEXT PRIMARY KEY, value TEXT)");
  database_->execute(
      "CREATE TABLE trials (trial INTEGER PRIMARY KEY, cell INTEGER, repetition INTEGER, "
      "seed INTEGER, succeeded INTEGER, outcome TEXT, truth_outcome TEXT, cause TEXT, "
      "sentence TEXT, jumps INTEGER, landed INTEGER, " +
      columns + "path BLOB)");
  set_note("schema", kSchema);
  set_note("identity", identity_.identity);
  set_note("program", identity_.program);
  set_note("pairing", identity_.pairing);
  set_note("name", identity_.name);
  set_note("source", identity_.source);
  set_note("cells", std::to_string(identity_.cells));
  set_note("factors", factors_text(identity_.factors));
  database_->execute("COMMIT");
}

void Store::read_identity() {
  std::string schema;
  try {
    schema = note("schema");
  } catch (const std::exception&) {
    schema.clear();
  }
  if (schema != kSchema) {
    throw core::ConfigError(file_.string() +
                            ": is no store of a campaign, or one of another "
                            "version (schema \"" +
                            schema + "\", but \"" + kSchema + "\")");
  }
  identity_.identity = note("identity");
  identity_.program = note("program");
  identity_.pairing = note("pairing");
  identity_.name = note("name");
  identity_.source = note("source");
  identity_.cells = std::stoll(note("cells"));
  identity_.factors = factors_from(note("factors"));
}

void Store::require_same(const StoreIdentity& wanted) const {
  if (identity_.identity != wanted.identity) {
    throw core::ConfigError(file_.string() + ": holds another campaign (\"" + identity_.name +
                            "\", identity " + identity_.identity + ", but " + wanted.identity +
                            "): its file, the tuning or a robot differ; give another --out");
  }
  if (identity_.program != wanted.program) {
    throw core::ConfigError(file_.string() + ": holds trials of program " + identity_.program +
                            ", but this is " + wanted.program +
                            "; results of two programs do not mix: give another --out");
  }
}

void Store::prepare_insert() {
  const std::size_t columns = kLastFixedColumn + 1 + number_columns(identity_).size() + 1;
  std::string sql = "INSERT OR IGNORE INTO trials VALUES (?";
  for (std::size_t i = 1; i < columns; ++i) sql += ",?";
  if (sqlite3_prepare_v2(database_->handle, (sql + ")").c_str(), -1, &database_->insert, nullptr) !=
      SQLITE_OK) {
    database_->fail();
  }
}

bool Store::add(const TrialResult& result) {
  sqlite3_stmt* row = database_->insert;
  int column = 0;
  const auto text = [&](const std::string& value) {
    sqlite3_bind_text(row, ++column, value.data(), static_cast<int>(value.size()),
                      SQLITE_TRANSIENT);
  };
  const auto integer = [&](std::int64_t value) { sqlite3_bind_int64(row, ++column, value); };
  const auto number = [&](double value) { sqlite3_bind_double(row, ++column, value); };
  const TrialPlace place = place_of(result.index, identity_.cells);
  sqlite3_clear_bindings(row);
  integer(result.index);
  integer(place.cell);
  integer(place.repetition);
  integer(static_cast<std::int64_t>(result.seed));
  integer(result.succeeded() ? 1 : 0);
  text(result.outcome);
  text(result.truth_outcome);
  text(result.cause);
  text(result.sentence);
  integer(result.jumps);
  integer(result.landed);
  for (const Metric& metric : kMetrics) number(result.*metric.value);
  for (std::size_t i = 0; i < identity_.factors.size(); ++i) {
    number(i < result.values.size() ? result.values[i] : core::kNaN);  // NaN is stored as null
  }
  number(result.wall);
  if (!result.path.empty()) {
    sqlite3_bind_blob(row, ++column, result.path.data(),
                      static_cast<int>(result.path.size() * sizeof(result.path[0])),
                      SQLITE_TRANSIENT);
  }
  const int status = sqlite3_step(row);
  sqlite3_reset(row);
  if (status != SQLITE_DONE) database_->fail();
  return sqlite3_changes(database_->handle) > 0;
}

void Store::for_each(Paths paths, const std::function<void(const TrialResult&)>& visit) const {
  Statement rows(database_->handle, "SELECT * FROM trials ORDER BY trial");
  while (rows.step()) visit(row_of(rows, identity_, paths));
}

void Store::for_each_path(std::int64_t cells,
                          const std::function<void(const TrialResult&)>& visit) const {
  Statement rows(database_->handle,
                 "SELECT * FROM trials WHERE path IS NOT NULL AND cell < ? ORDER BY trial");
  rows.bind(1, cells);
  while (rows.step()) visit(row_of(rows, identity_, Paths::with));
}

std::optional<TrialResult> Store::find(std::int64_t index) const {
  Statement rows(database_->handle, "SELECT * FROM trials WHERE trial = ?");
  rows.bind(1, index);
  if (!rows.step()) return std::nullopt;
  return row_of(rows, identity_, Paths::with);
}

std::string Store::note(const std::string& key) const {
  Statement row(database_->handle, "SELECT value FROM campaign WHERE key = ?");
  row.bind(1, key);
  return row.step() ? row.text(0) : "";
}

void Store::set_note(const std::string& key, const std::string& value) {
  Statement row(database_->handle, "INSERT OR REPLACE INTO campaign VALUES (?, ?)");
  row.bind(1, key);
  row.bind(2, value);
  row.step();
}

double Store::elapsed() const {
  const std::string text = note("elapsed_s");
  return text.empty() ? 0.0 : std::stod(text);
}

void Store::add_elapsed(double seconds) {
  set_note("elapsed_s", exact_text(elapsed() + seconds));
}

std::int64_t merge(const fs::path& from, Store& into) {
  const Store other(from);
  const StoreIdentity& theirs = other.identity();
  const StoreIdentity& ours = into.identity();
  if (theirs.identity != ours.identity || theirs.program != ours.program) {
    throw core::ConfigError(from.string() + ": is of another campaign or program (\"" +
                            theirs.name + "\", " + theirs.program + ") and cannot be merged");
  }
  std::int64_t added = 0;
  other.for_each(Store::Paths::with,
                 [&](const TrialResult& result) { added += into.add(result) ? 1 : 0; });
  into.add_elapsed(other.elapsed());
  return added;
}

}  // namespace hopscotch::apps::campaign
