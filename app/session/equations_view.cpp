#include "session/equations_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"
#include "model/model.hpp"

namespace achilles {

// ---- layout of equations in lines and columns ----

namespace {

using Ink = TypesetSheet::Ink;

// Relative to the letter size.
constexpr float caption_size = 0.867F, leading = 0.38F, before_caption = 0.3F, before_now = 0.25F, now_height = 1.25F,
                between_columns = 2.2F, min_column = 20.0F;
constexpr int most_sheet_columns = 3;

// A block of lines that must stay together, positioned from (0, 0).
struct SheetBlock {
    std::vector<TypesetSheet::SheetLine> lines;
    std::vector<TypesetSheet::ConditionPlace> now;
    float width = 0.0F, height = 0.0F;
    bool begins_group = false, is_heading = false;
};

class Setter {
 public:
    Setter(const EquationSheet& sheet, float size, const FormulaFont& font, float column)
        : sheet_(sheet), size_(size), font_(font), column_(column) {
        for (const EquationSheet::Symbol& symbol : sheet.symbols)
            names_.push_back({symbol.latex, typeset(symbol.name)});
    }

    std::vector<SheetBlock> units() {
        for (std::size_t i = 0; i < sheet_.blocks.size(); ++i) {
            block_ = i;
            add(sheet_.blocks[i]);
            for (std::size_t k = 0; k < sheet_.conditions.size(); ++k)
                if (sheet_.conditions[k].last == i + 1) now(k);
        }
        return std::move(units_);
    }

 private:
    void add(const Block& block) {
        const std::string left = block.words.latex;
        switch (block.kind) {
            case Block::Kind::heading:
                begin(before_heading);
                units_.back().begins_group = units_.back().is_heading = true;
                return lines(read_sentence(left, names_), size_, 0.0F, Ink::heading);
            case Block::Kind::caption:
                begin(before_caption);
                return lines(read_sentence(left, names_), caption_size * size_, 0.0F, Ink::caption);
            case Block::Kind::matrix:
                return matrix(left, block.rows);
            case Block::Kind::formula:
                return formula(left, read_formula(block.right, names_));
            case Block::Kind::lines:
                return table(block.rows);
            case Block::Kind::title:
            case Block::Kind::sentence:
                return lines(in_words(read_sentence(left, names_)), caption_size * size_, 0.0F, Ink::caption);
        }
    }

    // A table of names and sentences. A row without a name continues the one above. A short table stays together.
    void table(const std::vector<std::vector<std::string>>& rows) {
        constexpr std::size_t most_together = 8;
        std::size_t entries = 0;
        const float size = caption_size * size_;
        float left = 0.0F;
        for (const auto& row : rows) left = std::max(left, set(read_sentence(row.front(), names_), size, font_).width);
        left = std::min(left + size_, 0.4F * column_);
        for (const auto& row : rows) {
            if (!row.front().empty() && entries++ % most_together == 0) begin(0.0F);
            FormulaBox line = set(read_sentence(row.front(), names_), size, font_);
            if (line.width > left - 0.5F * size_) put(std::exchange(line, {}), 0.0F, Ink::formula);
            Formula sentence = read_sentence(row.back(), names_);
            for (FormulaPiece& piece : sentence.pieces)
                if (piece.kind == FormulaPiece::Kind::letters && piece.label.find('^') != std::string::npos)
                    piece.label = typeset_unit(piece.label);
            for (const FormulaBox& part : set_in_lines(in_words(sentence), size, font_, column_ - left, 0.0F)) {
                line.put(part, left, 0.0F);
                put(std::exchange(line, {}), 0.0F, Ink::formula);
            }
        }
    }

    // Fractions too wide for the column are written inline as N/D.
    Formula in_words(const Formula& row) const {
        Formula result;
        const auto bracketed = [&](const Formula& part) {
            const bool is_alone = part.pieces.size() == 1;
            if (!is_alone) result.pieces.emplace_back().kind = FormulaPiece::Kind::open;
            if (!is_alone) result.pieces.back().label = "(";
            for (const FormulaPiece& piece : part.pieces) result.pieces.push_back(piece);
            if (!is_alone) result.pieces.emplace_back().kind = FormulaPiece::Kind::close;
            if (!is_alone) result.pieces.back().label = ")";
        };
        for (const FormulaPiece& piece : row.pieces) {
            const bool is_wide = piece.kind == FormulaPiece::Kind::fraction && width_of(piece) > column_;
            if (!is_wide) {
                result.pieces.push_back(piece);
                continue;
            }
            bracketed(piece.parts[0]);
            result.pieces.emplace_back().label = "/";
            bracketed(piece.parts[1]);
        }
        return result;
    }
    float width_of(const FormulaPiece& fraction) const {
        return std::max(display(fraction.parts[0]), display(fraction.parts[1])) + size_;
    }

    void begin(float space) {
        units_.emplace_back();
        if (units_.size() > 1) units_.back().height = space * size_;
    }

    void put(FormulaBox box, float x, Ink ink) {
        if (units_.empty()) begin(0.0F);
        SheetBlock& unit = units_.back();
        // Lines of plain letters get the line spacing of text.
        const float ascent = std::max(box.ascent, 0.72F * size_), descent = std::max(box.descent, 0.22F * size_);
        const float y = std::round(unit.height + ascent);
        unit.width = std::max(unit.width, x + box.width);
        unit.height = y + descent + leading * size_;
        unit.is_heading = unit.is_heading && ink == Ink::heading;
        unit.lines.push_back({x, y, std::move(box), ink, block_});
    }

    void lines(const Formula& row, float size, float indent, Ink ink) {
        bool is_first = true;
        for (FormulaBox& box : set_in_lines(row, size, font_, column_, indent)) {
            put(std::move(box), is_first ? 0.0F : indent, ink);
            is_first = false;
        }
    }

    // A fraction wider than the column becomes N/D, with N and D below.
    void formula(const std::string& left, Formula right) {
        const Formula beginning = left.empty() ? Formula{} : joined({read_formula(left + " =", {})});
        std::vector<std::pair<std::string, Formula>> below;
        for (FormulaPiece& piece : right.pieces) {
            if (piece.kind != FormulaPiece::Kind::fraction) continue;
            if (width_of(piece) <= column_) continue;
            const std::string number = below.empty() ? "" : fmt::format("_{{{}}}", below.size() / 2 + 1);
            below.emplace_back("N" + number, std::move(piece.parts[0]));
            below.emplace_back("D" + number, std::move(piece.parts[1]));
            piece.parts = {read_formula("N" + number, {}), read_formula("D" + number, {})};
        }
        if (!below.empty()) right = joined({std::move(right), read_sentence(", where", {})});
        const float hanging = std::min(0.3F * column_, set(beginning, size_, font_).width + 0.6F * size_);
        lines(joined({beginning, std::move(right)}), size_, hanging, Ink::formula);
        for (auto& [name, part] : below) formula(name, std::move(part));
    }

    float display(const Formula& row) const {
        float width = 0.0F;
        for (const FormulaBox& line : set_in_lines(row, size_, font_, 1e9F, 0.0F)) width += line.width;
        return width;
    }

    // As a matrix in brackets if there is room, else entry by entry; a square matrix is symmetric, so each entry once.
    void matrix(const std::string& left, const std::vector<std::vector<std::string>>& rows) {
        std::vector<std::vector<Formula>> entries;
        for (const auto& row : rows) {
            entries.emplace_back();
            for (const std::string& entry : row) entries.back().push_back(read_formula(entry, names_));
        }
        const FormulaBox beginning = set(read_formula(left + " =", {}), size_, font_);
        const FormulaBox right = set_matrix(entries, size_, font_);
        const float at = beginning.width + 0.3F * size_;
        if (at + right.width <= column_) {
            FormulaBox box = beginning;
            box.put(right, at, 0.0F);
            return put(std::move(box), 0.0F, Ink::formula);
        }
        const bool is_vector = entries.size() == 1 || entries.front().size() == 1;
        for (std::size_t i = 0; i < entries.size(); ++i)
            for (std::size_t j = is_vector ? 0 : i; j < entries[i].size(); ++j)
                formula(is_vector ? fmt::format("{{{}}}_{{{}}}", left, i + j + 1)
                                  : fmt::format("{{{}}}_{{{}{}}}", left, i + 1, j + 1),
                        std::move(entries[i][j]));
    }

    void now(std::size_t condition) {
        SheetBlock& unit = units_.back();
        unit.height += before_now * size_;
        unit.now.push_back({condition, 0.0F, unit.height, column_});
        unit.height += now_height * size_;
    }

    const EquationSheet& sheet_;
    const float size_;
    const FormulaFont& font_;
    const float column_;
    std::vector<FormulaName> names_;
    std::vector<SheetBlock> units_;
    std::size_t block_ = 0;
};

// Distributes the units over columns of about the same height. A group starts a new column rather than being split.
TypesetSheet in_columns(const std::vector<SheetBlock>& units, int columns, float column, float size) {
    float total = 0.0F;
    for (const SheetBlock& unit : units) total += unit.height;
    const float target = total / static_cast<float>(columns);
    TypesetSheet page;
    float x = 0.0F, y = 0.0F, widest = 0.0F;
    int at = 0;
    for (std::size_t i = 0; i < units.size(); ++i) {
        const SheetBlock& unit = units[i];
        const bool is_last = at + 1 == columns, after_heading = i > 0 && units[i - 1].is_heading;
        const float filled = y + 0.5F * unit.height;
        if (!is_last && y > 0.0F && !after_heading && (filled > target || (unit.begins_group && y > 0.7F * target))) {
            x += std::max(column, widest) + between_columns * size;
            y = widest = 0.0F;
            ++at;
        }
        // No space above the first line of a column.
        const float space = y == 0.0F && !unit.lines.empty()
                                ? unit.lines.front().y - std::max(unit.lines.front().box.ascent, 0.72F * size)
                                : 0.0F;
        for (TypesetSheet::SheetLine line : unit.lines) {
            line.x += x;
            line.y += y - std::floor(space);
            page.lines.push_back(std::move(line));
        }
        for (TypesetSheet::ConditionPlace now : unit.now)
            page.now.push_back({now.condition, now.x + x, now.y + y - std::floor(space), now.width});
        y += unit.height - std::floor(space);
        widest = std::max(widest, unit.width);
        page.height = std::max(page.height, y);
        page.width = std::max(page.width, x + unit.width);
    }
    return page;
}

}  // namespace

TypesetSheet set_sheet(const EquationSheet& sheet, float size, const FormulaFont& font, float width, float height) {
    TypesetSheet page;
    for (int columns = 1; columns <= most_sheet_columns; ++columns) {
        const float gaps = static_cast<float>(columns - 1) * between_columns * size;
        const float column = std::floor((width - gaps) / static_cast<float>(columns));
        if (columns > 1 && column < min_column * size) break;
        TypesetSheet next =
            in_columns(Setter(sheet, size, font, std::max(column, 1.0F)).units(), columns, column, size);
        if (columns > 1 && (next.height >= page.height || next.width > width)) break;
        page = std::move(next);
        if (page.height <= height) break;
    }
    return page;
}

const EquationSheet* EquationsView::sheet(const std::shared_ptr<const Model>& model, const Run& run, Timeout patience) {
    std::vector<double> signs;
    for (std::size_t i = 0; i < run.parameters.size(); ++i) {
        const auto& range = model->description().parameters[i].range;
        signs.push_back(std::min(range[0], run.parameters[i]));
        signs.push_back(std::max(range[1], run.parameters[i]));
    }
    if (model != model_ || signs != signs_) {
        if (worker_ == nullptr) worker_ = std::make_unique<Worker<SheetResult>>();
        if (model != model_) sheet_.reset();
        model_ = model;
        signs_ = signs;
        is_under_way_ = true;
        worker_->start([model, run](const std::stop_token& stop) -> SheetResult {
            try {
                return std::make_shared<const EquationSheet>(equation_sheet(*model, run, stop));
            } catch (const std::exception& too_large) {  // too many terms, or out of memory
                EquationSheet sheet;
                const std::string why = Page::escaped(too_large.what());
                sheet.blocks.push_back({Block::Kind::sentence, {why, "The equations are not written out: " + why}, {}});
                return std::make_shared<const EquationSheet>(std::move(sheet));
            }
        });
    }
    if (is_under_way_)
        if (std::optional<SheetResult> made = worker_->take(patience)) {
            sheet_ = *made;
            is_under_way_ = false;
            typeset_key_.clear();
            evaluators_.clear();
        }
    return sheet_.get();
}

const EquationSheet& EquationsView::mechanism(const std::shared_ptr<const Model>& model, const Run& run) {
    if (model == mechanism_model_ && mechanism_run_ == run) return mechanism_;
    mechanism_model_ = model;
    mechanism_run_ = run;
    mechanism_ = mechanism_sheet(*model, run);
    mechanism_key_.clear();
    return mechanism_;
}

const TypesetSheet& EquationsView::typeset_mechanism(float size, const FormulaFont& font, float width, float height) {
    const std::vector<float> key{size, width, height};
    if (key == mechanism_key_) return typeset_mechanism_;
    mechanism_key_ = key;
    return typeset_mechanism_ = set_sheet(mechanism_, size, font, width, height);
}

const TypesetSheet& EquationsView::typeset_sheet(float size, const FormulaFont& font, float width, float height) {
    const std::vector<float> key{size, width, height};
    if (typeset_key_ == key) return typeset_;
    typeset_key_ = key;
    typeset_ = set_sheet(*sheet_, size, font, width, height);
    return typeset_;
}

double EquationsView::value(std::size_t condition, const Model& model, const Run& run, const State& state, double t) {
    if (parameters_ != run.parameters) evaluators_.clear();
    parameters_ = run.parameters;
    const Program& program = sheet_->conditions[condition].decisive;
    Evaluator<double>& evaluator =
        evaluators_.try_emplace(condition, model.evaluator(program, run.parameters)).first->second;
    const Layout& layout = model.layout();
    for (int i = 0; i < model.dof(); ++i) {
        evaluator.input(layout.q(static_cast<std::size_t>(i))) = state.q[i];
        evaluator.input(layout.v(static_cast<std::size_t>(i))) = state.v[i];
    }
    evaluator.input(layout.t()) = t;
    evaluator.run();
    return evaluator.output(0);
}

}  // namespace achilles
