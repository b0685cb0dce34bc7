#include "packing/run_checkpoint.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "core/error.hpp"

namespace pelletlab::packing {

namespace {

constexpr std::string_view magic = "PLABRUN1";

/// 64-bit FNV-1a: against damage, not against malice.
std::uint64_t checksum_of(std::string_view bytes) {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
    return hash;
}

class Writer {
public:
    void put(std::uint64_t word) { bytes.append(reinterpret_cast<const char*>(&word), sizeof word); }
    void put(double number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); }
    void put(std::string_view text) {
        put(static_cast<std::uint64_t>(text.size()));
        bytes.append(text);
    }
    std::string bytes;
};

class Reader {
public:
    Reader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}
    std::string_view take(std::size_t size) {
        if (size > rest_.size()) broken();
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    std::uint64_t word() {
        std::uint64_t word;
        std::memcpy(&word, take(sizeof word).data(), sizeof word);
        return word;
    }
    double number() {
        double number;
        std::memcpy(&number, take(sizeof number).data(), sizeof number);
        if (!std::isfinite(number)) broken();
        return number;
    }
    /// A count of things of `size` bytes each that must fit into what is left.
    std::size_t count(std::size_t size) {
        const std::uint64_t n = word();
        if (n > rest_.size() / size) broken();
        return static_cast<std::size_t>(n);
    }
    std::string_view text() { return take(count(1)); }
    bool at_end() const { return rest_.empty(); }
    [[noreturn]] void broken() const { throw bad_input("the checkpoint of the run is damaged or cut off", "start the run again with --force", {name_}); }

private:
    std::string_view rest_;
    const std::string& name_;
};

}  // namespace

std::string to_bytes(const RunCheckpoint& checkpoint, std::string_view owner) {
    Writer w;
    w.bytes = magic;
    w.put(owner);
    w.put(static_cast<std::uint64_t>(checkpoint.ended.size()));
    for (const StageEnd end : checkpoint.ended) w.put(static_cast<std::uint64_t>(end));
    w.put(checkpoint.done);
    w.put(static_cast<std::uint64_t>(checkpoint.memory.size()));
    for (const double number : checkpoint.memory) w.put(number);
    w.put(checkpoint.frames);
    w.put(checkpoint.meter.steps);
    w.put(checkpoint.meter.wall_seconds);
    w.put(checkpoint.meter.largest_overlap_ratio);
    w.put(std::string_view(checkpoint.simulation));
    w.put(checksum_of(w.bytes));
    return std::move(w.bytes);
}

RunCheckpoint checkpoint_from(std::string_view bytes, std::string_view owner, const std::string& name) {
    if (bytes.substr(0, magic.size()) != magic) throw bad_input("this is no checkpoint of a run", "start the run again with --force", {name});
    Reader sum(bytes.size() >= 8 ? bytes.substr(bytes.size() - 8) : bytes, name);
    Reader r(bytes.substr(0, bytes.size() - 8), name);
    if (sum.word() != checksum_of(bytes.substr(0, bytes.size() - 8))) sum.broken();
    r.take(magic.size());
    if (r.text() != owner)
        throw bad_input("the checkpoint belongs to another case, or another version of the program wrote it",
                        "go on with that case and program, or start this one with --force: the checkpoint is then lost", {name});
    RunCheckpoint checkpoint;
    for (std::size_t left = r.count(8); left > 0; --left) {
        const std::uint64_t end = r.word();
        if (end > static_cast<std::uint64_t>(StageEnd::watch_ended_it)) r.broken();
        checkpoint.ended.push_back(static_cast<StageEnd>(end));
    }
    checkpoint.done = r.word();
    for (std::size_t left = r.count(8); left > 0; --left) checkpoint.memory.push_back(r.number());
    checkpoint.frames = r.word();
    checkpoint.meter.steps = r.word();
    checkpoint.meter.wall_seconds = r.number();
    checkpoint.meter.largest_overlap_ratio = r.number();
    checkpoint.simulation = std::string(r.text());
    if (!r.at_end()) r.broken();
    return checkpoint;
}

}  // namespace pelletlab::packing
