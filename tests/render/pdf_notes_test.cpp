#include "image/notes.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace achilles {
namespace {

// An empty page in the format of cairo.
std::string small_pdf() {
    std::string text = "%PDF-1.5\n%\xB5\xED\xAE\xFB\n", table = "xref\n0 5\n0000000000 65535 f \n";
    int object = 0;
    for (const char* body :
         {"<< /Type /Pages\n   /Kids [ 2 0 R ]\n   /Count 1\n>>", "<< /Type /Page % 1\n   /MediaBox [ 0 0 75 60 ]\n>>",
          "<< /Producer (cairo 1.16.0 (https://cairographics.org))\n   /CreationDate (19700101000000+00'00)\n>>",
          "<< /Type /Catalog\n   /Pages 1 0 R\n>>"}) {
        const std::string at = std::to_string(text.size());
        table += std::string(10 - at.size(), '0') + at + " 00000 n \n";
        text += std::to_string(++object) + " 0 obj\n" + body + "\nendobj\n";
    }
    return text + table + "trailer\n<< /Size 5\n   /Root 4 0 R\n   /Info 3 0 R\n>>\nstartxref\n" +
           std::to_string(text.size()) + "\n%%EOF\n";
}

const Notes awkward_notes{{"Title", "A (ball) \\ with )("},
                          {"Software", "Achilles 0.1.0"},
                          {"Achilles Command", "achilles figure 'a \\(b'"},
                          {"Achilles System", "./a.toml\ntitle = \"θ 𝑥 \xEF\xBF\xBD\"\r\n>>\nendobj\n"},
                          {"Achilles System", "./b.toml\ntitle = 1\r\n\t\x01>>\nendobj\n%Achilles notes\n"},
                          {"Comment", ""}};

TEST(PdfNotes, ComeBackInOrder) {
    EXPECT_EQ(pdf_notes(with_pdf_notes(small_pdf(), awkward_notes)), awkward_notes);
    EXPECT_TRUE(pdf_notes(small_pdf()).empty());
    EXPECT_TRUE(pdf_notes(with_pdf_notes(small_pdf(), {})).empty());
    EXPECT_EQ(with_pdf_notes(small_pdf(), awkward_notes), with_pdf_notes(small_pdf(), awkward_notes));
}

// Follows the file as a PDF reader does: from its end to the cross-reference table, and from there to the object.
TEST(PdfNotes, AreAnUpdateOfTheInformationDictionary) {
    const std::string before = small_pdf(), pdf = with_pdf_notes(before, awkward_notes);
    EXPECT_EQ(pdf.substr(0, before.size()), before);
    EXPECT_TRUE(pdf.ends_with("\n%%EOF\n"));
    const auto number_behind = [&](const std::string& word) {
        return std::stoul(pdf.substr(pdf.rfind(word) + word.size()));
    };
    const std::size_t table = number_behind("startxref\n");
    const std::string head = "xref\n3 1\n";
    ASSERT_EQ(pdf.substr(table, head.size()), head);
    const std::size_t object = std::stoul(pdf.substr(table + head.size()));
    EXPECT_EQ(pdf.substr(table + head.size() + 10, 10), " 00000 n \n");
    EXPECT_EQ(pdf.substr(object, 20), "3 0 obj\n<< /Producer");
    EXPECT_EQ(before.substr(number_behind("/Prev "), 9), "xref\n0 5\n");
    EXPECT_NE(pdf.find("trailer\n<< /Size 5\n   /Root 4 0 R\n   /Info 3 0 R\n   /Prev ", table), std::string::npos);
    const std::string said = pdf.substr(object, table - object);
    for (const char* entry :
         {"/CreationDate (19700101000000+00'00)\n", "\n/Title (A \\(ball\\) \\\\ with \\)\\()\n",
          "\n/Creator (Achilles 0.1.0)\n", "\n/Achilles#20Command (achilles figure 'a \\\\\\(b')\n",
          "\n/Achilles#20System (\\376\\377\\000.\\000/", "\n/Achilles#20System#202 (./b.toml\\ntitle"})
        EXPECT_NE(said.find(entry), std::string::npos) << entry << said;
    EXPECT_TRUE(said.ends_with(">>\nendobj\n"));
}

TEST(PdfNotes, AnotherFileOrTextIsRefused) {
    for (const char* other : {"", "%PDF-1.7\n", "%PDF-1.5\ntrailer\n<< /Info 3 0 R >>\nstartxref\n0\n%%EOF\n"})
        EXPECT_THROW(with_pdf_notes(other, awkward_notes), std::runtime_error) << other;
    EXPECT_THROW(with_pdf_notes(small_pdf(), {{"Comment", "\xff"}}), std::runtime_error);
}

TEST(PdfNotes, DamagedOnesAreRefusedWhereverTheyEnd) {
    const std::string pdf = with_pdf_notes(small_pdf(), awkward_notes), begin = "\n%Achilles notes\n";
    const std::size_t first = pdf.find(begin) + begin.size(), last = pdf.rfind(">>\nendobj");
    for (std::size_t size = first; size < last + 3; ++size)
        EXPECT_THROW(pdf_notes(pdf.substr(0, size)), std::runtime_error) << size;
    for (const char* line :
         {"/a", "/a b", "a (b)", "/a (\\", "/a (\\12)", "/a (\\389)", "/a (\\376\\377\\000)",
          "/a (\\376\\377\\330\\000\\000a)", "/a (\\376\\377\\334\\000)", "/a# (b)", "/a (\\300)", ""})
        EXPECT_THROW(pdf_notes(begin + std::string(line) + "\n>>\n"), std::runtime_error) << line;
}

}  // namespace
}  // namespace achilles
