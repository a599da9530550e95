#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

// Reports to the console as usual and remembers the best result of each benchmark: the repetition that
// other programs disturbed least. Then compares these results with the aims.
class AimsTable : public benchmark::ConsoleReporter
{
public:
    void ReportRuns(const std::vector<Run> &runs) override;
    // Prints the aims and the measured values as a Markdown table. Returns whether all aims are met.
    bool Print() const;

private:
    struct Result
    {
        double Nanoseconds = 0.0;
        std::map<std::string, double> Counters;  // the smallest of each
    };

    // Zero if the benchmark was not run.
    double Time(const std::string &name) const;
    double Counter(const std::string &name, const std::string &counter) const;

    std::map<std::string, Result> _results;
};
