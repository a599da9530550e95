// Damaged IDL texts, made of good ones by chance and by changes that abuse the language.
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

class TextMutator
{
public:
    // `texts`: good texts, at least one.
    TextMutator(std::vector<std::string> texts, unsigned seed);
    // Returns one of the texts, changed in a few places: bytes, words, lines, definitions of others.
    std::string Next();

private:
    std::size_t Below(std::size_t limit) { return _random() % limit; }
    const std::string &AnyText() { return _texts[Below(_texts.size())]; }
    void ChangeAlike(std::string &text);
    void ChangeStatement(std::string &text);
    void ChangeByte(std::string &text);
    void ChangeWord(std::string &text);
    void ChangeLine(std::string &text);
    void ChangeNumber(std::string &text);

    std::vector<std::string> _texts;
    std::mt19937 _random;
};
