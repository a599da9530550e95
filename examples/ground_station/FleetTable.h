// The fleet as text: pure functions from rows to lines. Text that came from the network is made printable
// first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Ground
{

enum class RowState
{
    Waiting,  // never heard
    Up,
    Stale,  // not heard recently: its data gets old
    Lost
};

std::string ToText(RowState state);

// The data of one aircraft for the table.
struct FleetRow
{
    std::string Node;
    RowState State = RowState::Waiting;
    std::optional<double> AgeS;  // of the last pose, since it was true; none: no pose has come
    double LatitudeDeg = 0;
    double LongitudeDeg = 0;
    double AltitudeM = 0;
    double SpeedMps = 0;
    std::string Mission;       // empty: not known
    std::string BadPosition;   // why the position of the last pose is not believed; empty if it is
    std::string AreaDeclined;  // reason why it declines the search area; empty if it does not
    std::optional<double> BatteryPercent;  // 0 to 100; none: not known now
    std::uint64_t Sent = 0;
    std::uint64_t Acknowledged = 0;
    double RoundTripS = std::numeric_limits<double>::quiet_NaN();  // NaN: not known
    double DeliveryRate = 0;  // bytes a second of queue messages that arrive there; 0: not known

    // Below these an aircraft needs attention because of its battery. The web page has the same limits.
    static constexpr double BatteryAlarm = 10;
    static constexpr double BatteryWarning = 25;
    // A Health older than this tells nothing of the battery. The web page has the same limit.
    static constexpr double HealthFreshS = 3.5;
    bool IsBatteryBelow(double percent) const { return BatteryPercent && *BatteryPercent < percent; }

    // A pose older than this is marked as old even if the aircraft is UP.
    static constexpr double FreshS = 1.0;
    // True if pose and mission are current.
    bool IsFresh() const { return State == RowState::Up && AgeS && *AgeS <= FreshS; }
};

// Emphasis of a line of the table, on a terminal that can show it.
enum class Emphasis
{
    None,
    Heading,
    Warning,
    Alarm
};

struct TableLine
{
    std::string Text;  // one line of ASCII, no line end
    Emphasis Shown = Emphasis::None;
};

// The table with a title and a heading, for a screen of `columns` columns: LOST aircraft first, then STALE,
// UP with a low battery or a bad position, WAITING and UP, otherwise in the order of the rows. Old values are
// in parentheses, and their age has an exclamation mark before it, so that they stand out without colours
// too. Round trip and delivery rate have columns of their own, or are below the table if there is no room for
// them.
std::vector<TableLine> FleetTableLines(const std::vector<FleetRow> &rows, double elapsedS,
                                       std::size_t columns = 80);

// One self-contained line for each row, for a log: time, then the same columns as in the table, named.
std::vector<std::string> FleetLogLines(const std::vector<FleetRow> &rows, double elapsedS);

// Tells which data of an aircraft is missing while it is heard otherwise: `only its positions come`; empty if
// all is heard, or nothing. An aircraft is UP while its gateway's beats come.
std::string WhatIsMissing(const FleetRow &row);

// Limits of texts in a line, in characters: names of nodes, queues and messages, and reasons.
inline constexpr std::size_t LongestName = 64;
inline constexpr std::size_t LongestReason = 400;
// The text with everything but printable ASCII replaced by `?`, and cut to a length.
std::string Printable(const std::string &text, std::size_t longest);

}  // namespace Ground
