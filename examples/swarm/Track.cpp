#include "Track.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

namespace Swarm
{
namespace
{
constexpr std::uintmax_t MaxFileBytes = 100'000'000;
constexpr double WayBackSpeedMps = 5;
constexpr double MaxAngleRad = 6.2832;  // a whole turn either way: recorders use different ranges

struct Column
{
    std::string_view Name;
    double Min;
    double Max;
};

constexpr std::array<Column, 10> Columns{{{"time_s", 0, 1e9},
                                          {"latitude_deg", -90, 90},
                                          {"longitude_deg", -180, 180},
                                          {"altitude_m", -1000, 100000},
                                          {"velocity_north_mps", -1000, 1000},
                                          {"velocity_east_mps", -1000, 1000},
                                          {"velocity_down_mps", -1000, 1000},
                                          {"roll_rad", -MaxAngleRad, MaxAngleRad},
                                          {"pitch_rad", -MaxAngleRad, MaxAngleRad},
                                          {"yaw_rad", -MaxAngleRad, MaxAngleRad}}};

// One line of the file, with its position for errors.
struct Line
{
    const std::string &File;
    std::size_t Number;
    std::string_view Text;

    [[noreturn]] void Fail(std::size_t column, const std::string &expected) const
    {
        throw TrackError(File + ":" + std::to_string(Number) + ":" + std::to_string(column) + ": " +
                         expected);
    }
};

struct Field
{
    std::string_view Text;
    std::size_t Column;  // of its first character, counted from 1
};

std::string Quoted(std::string_view text)
{
    constexpr std::size_t Longest = 40;
    std::string quoted = "'";
    for (const char c : text.substr(0, Longest))
        quoted += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
    return quoted + (text.size() > Longest ? "...'" : "'");
}

std::string Number(double value)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

Field Trimmed(std::string_view text, std::size_t column)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
    {
        text.remove_prefix(1);
        ++column;
    }
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
        text.remove_suffix(1);
    return {text, column};
}

// Splits a line into exactly one field per column. Throws TrackError otherwise.
std::array<Field, Columns.size()> Split(const Line &line)
{
    std::array<Field, Columns.size()> fields;
    std::size_t start = 0;
    for (std::size_t i = 0; i < fields.size(); ++i)
    {
        const std::size_t comma = line.Text.find(',', start);
        const bool last = i + 1 == fields.size();
        if (!last && comma == std::string_view::npos)
            line.Fail(line.Text.size() + 1, "expected " + std::to_string(Columns.size()) +
                                                " columns separated by commas, found " +
                                                std::to_string(i + 1));
        if (last && comma != std::string_view::npos)
            line.Fail(comma + 1,
                      "expected the end of the line after " + std::to_string(Columns.size()) + " columns");
        fields[i] = Trimmed(line.Text.substr(start, comma - start), start + 1);
        start = comma + 1;
    }
    return fields;
}

void CheckHeader(const Line &line)
{
    std::size_t start = 0;
    for (const Column &column : Columns)
    {
        const std::size_t at = std::min(start, line.Text.size());
        const std::size_t comma = line.Text.find(',', at);
        const Field field = Trimmed(line.Text.substr(at, comma - at), at + 1);
        if (field.Text != column.Name)
            line.Fail(field.Column, "expected the column name " + std::string(column.Name) + ", found " +
                                        Quoted(field.Text));
        start = comma == std::string_view::npos ? line.Text.size() : comma + 1;
    }
    Split(line);  // refuses further fields
}

double Value(const Line &line, const Field &field, const Column &column)
{
    double value = 0;
    const char *end = field.Text.data() + field.Text.size();
    const auto [stop, error] = std::from_chars(field.Text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
        line.Fail(field.Column,
                  "expected a number for " + std::string(column.Name) + ", found " + Quoted(field.Text));
    if (value < column.Min || value > column.Max)
        line.Fail(field.Column, "expected " + std::string(column.Name) + " between " + Number(column.Min) +
                                    " and " + Number(column.Max) + ", found " + Quoted(field.Text));
    return value;
}

Track::Row ParseRow(const Line &line, const std::vector<Track::Row> &before)
{
    const auto fields = Split(line);
    std::array<double, Columns.size()> v{};
    for (std::size_t i = 0; i < v.size(); ++i)
        v[i] = Value(line, fields[i], Columns[i]);
    if (!before.empty() && v[0] <= before.back().TimeS)
        line.Fail(fields[0].Column, "expected time_s greater than " + Number(before.back().TimeS) +
                                        " of the row before, found " + Quoted(fields[0].Text));
    return {v[0], {{v[1], v[2], v[3]}, v[4], v[5], v[6], v[7], v[8], v[9]}};
}
}  // namespace

Track::Track(std::vector<Row> rows) : _rows(std::move(rows))
{
    const double start = _rows.front().TimeS;
    for (Row &row : _rows)
        row.TimeS -= start;
    const double wayBack = Between(_rows.back().At.Position, _rows.front().At.Position).LengthM();
    _wayBackS = std::max(1.0, wayBack / WayBackSpeedMps);
}

Track Track::Load(const std::string &path)
{
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw TrackError(path + ": cannot be read: no such file");
    if (status.type() == std::filesystem::file_type::none)
        throw TrackError(path + ": cannot be read: " + error.message());
    if (!std::filesystem::is_regular_file(status))
        throw TrackError(path + ": cannot be read: it is not a regular file");
    if (std::filesystem::file_size(path, error) > MaxFileBytes || error)
        throw TrackError(path + ": cannot be read: it is larger than 100 MB");
    std::ifstream file(path);
    if (!file)
        throw TrackError(path + ": cannot be read: opening it failed");
    return Parse(file, path);
}

Track Track::Parse(std::istream &text, const std::string &name)
{
    std::vector<Row> rows;
    std::string buffer;
    std::size_t number = 0;
    std::size_t firstEmpty = 0;
    while (std::getline(text, buffer))
    {
        ++number;
        std::string_view content = buffer;
        if (number == 1 && content.starts_with("\xEF\xBB\xBF"))  // byte order mark
            content.remove_prefix(3);
        if (content.ends_with('\r'))
            content.remove_suffix(1);
        const Line line{name, number, content};
        if (number == 1)
        {
            CheckHeader(line);
            continue;
        }
        if (content.empty())
        {
            if (firstEmpty == 0)
                firstEmpty = number;
            continue;
        }
        if (firstEmpty != 0)
            Line{name, firstEmpty, ""}.Fail(1, "expected a row, found an empty line");
        rows.push_back(ParseRow(line, rows));
    }
    if (text.bad())
        throw TrackError(name + ": cannot be read: reading failed after line " + std::to_string(number));
    if (number == 0)
        Line{name, 1, ""}.Fail(1, "expected the line of column names, found an empty file");
    if (rows.empty())
        Line{name, 2, ""}.Fail(1, "expected at least one row after the column names");
    return Track(std::move(rows));
}

double Track::DurationS() const
{
    return _rows.back().TimeS;
}

Motion Track::At(double seconds) const
{
    const double t = std::fmod(std::max(seconds, 0.0), RoundS());
    const auto after = std::upper_bound(_rows.begin(), _rows.end(), t,
                                        [](double s, const Row &row) { return s < row.TimeS; });
    const Row &from = *(after - 1);
    if (after == _rows.end())
    {
        const Motion &first = _rows.front().At;
        const Offset way = Between(from.At.Position, first.Position);
        Motion motion;
        motion.Position = Interpolate(from.At.Position, first.Position, (t - from.TimeS) / _wayBackS);
        motion.NorthMps = way.NorthM / _wayBackS;
        motion.EastMps = way.EastM / _wayBackS;
        motion.DownMps = -way.UpM / _wayBackS;
        motion.YawRad = std::atan2(way.EastM, way.NorthM);
        return motion;
    }
    const double share = (t - from.TimeS) / (after->TimeS - from.TimeS);
    const Motion &a = from.At;
    const Motion &b = after->At;
    return {Interpolate(a.Position, b.Position, share),  std::lerp(a.NorthMps, b.NorthMps, share),
            std::lerp(a.EastMps, b.EastMps, share),      std::lerp(a.DownMps, b.DownMps, share),
            InterpolateRad(a.RollRad, b.RollRad, share), InterpolateRad(a.PitchRad, b.PitchRad, share),
            InterpolateRad(a.YawRad, b.YawRad, share)};
}

}  // namespace Swarm
