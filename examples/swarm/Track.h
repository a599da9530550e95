#pragma once

#include "BadInput.h"
#include "Geo.h"

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace Swarm
{

// A track file that cannot be used. what() is one line for a person: `file:line:column: what was expected`,
// or `file: reason` if the file cannot be read at all.
class TrackError : public Common::BadInput
{
public:
    using Common::BadInput::BadInput;
};

// A recorded flight, flown in a loop.
//
// The file is CSV text (fields separated by commas, no quotes). Its first line is
//   time_s,latitude_deg,longitude_deg,altitude_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,
//   roll_rad,pitch_rad,yaw_rad
// and every further line one row of ten numbers. Times increase; they need not start at 0 nor be evenly
// spaced. Lines may end in CR LF; empty lines are allowed at the end only.
//
// Immutable once made; may be used from any thread.
class Track
{
public:
    struct Row
    {
        double TimeS = 0;
        Motion At;
    };

    // Reads a file of at most 100 MB. Throws TrackError.
    static Track Load(const std::string &path);
    // Reads a stream; `name` stands for the file in errors. Throws TrackError.
    static Track Parse(std::istream &text, const std::string &name);

    // The motion that many seconds after the start, linear between the rows (angles the short way round).
    // After the last row the aircraft flies straight back to the first, at 5 m/s, and starts again.
    // Negative times count as 0.
    Motion At(double seconds) const;

    std::size_t Rows() const { return _rows.size(); }
    // Seconds from the first row to the last.
    double DurationS() const;
    // Seconds for one round: the duration and the way back, which takes at least a second.
    double RoundS() const { return DurationS() + _wayBackS; }

private:
    explicit Track(std::vector<Row> rows);

    std::vector<Row> _rows;  // at least one; times start at 0
    double _wayBackS = 1;
};

}  // namespace Swarm
