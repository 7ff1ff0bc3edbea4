// gui.cpp: the bridge to Dear ImGui.  Nothing is decided here but how things look.
#include "live/window/gui.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <cmath>
#include <cstring>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

namespace
{

ImFont     *plain, *source;
const char *navigated; // the panel that is to have the keys; nullptr: it has them, or none has
const float margin = 12, labels = 0.36f;

ImVec4 tone_color(GuiTone tone)
{
    switch (tone) {
    case GUI_FAINT: return ImVec4(0.60f, 0.61f, 0.63f, 1);
    case GUI_STRONG: return ImVec4(1, 1, 1, 1);
    case GUI_WARNING: return ImVec4(0.95f, 0.76f, 0.42f, 1);
    case GUI_ERROR: return ImVec4(1.0f, 0.50f, 0.46f, 1);
    default: return ImVec4(0.88f, 0.89f, 0.90f, 1);
    }
}

void set_colors(ImVec4 *colors)
{
    const ImVec4 accent(0.36f, 0.58f, 0.78f, 1), well(1, 1, 1, 0.07f), over(1, 1, 1, 0.12f);
    colors[ImGuiCol_Text]             = tone_color(GUI_PLAIN);
    colors[ImGuiCol_TextDisabled]     = tone_color(GUI_FAINT);
    colors[ImGuiCol_WindowBg]         = ImVec4(0.085f, 0.09f, 0.10f, 0.86f);
    colors[ImGuiCol_PopupBg]          = ImVec4(0.10f, 0.105f, 0.115f, 0.97f);
    colors[ImGuiCol_Border]           = ImVec4(1, 1, 1, 0.07f);
    colors[ImGuiCol_FrameBg]          = well;
    colors[ImGuiCol_FrameBgHovered]   = over;
    colors[ImGuiCol_FrameBgActive]    = ImVec4(1, 1, 1, 0.16f);
    colors[ImGuiCol_SliderGrab]       = accent;
    colors[ImGuiCol_SliderGrabActive] = ImVec4(0.50f, 0.72f, 0.92f, 1);
    colors[ImGuiCol_Button]           = well;
    colors[ImGuiCol_ButtonHovered]    = over;
    colors[ImGuiCol_ButtonActive]     = accent;
    colors[ImGuiCol_Header]           = well;
    colors[ImGuiCol_HeaderHovered]    = over;
    colors[ImGuiCol_HeaderActive]     = accent;
    colors[ImGuiCol_CheckMark]        = accent;
    colors[ImGuiCol_Separator]        = ImVec4(1, 1, 1, 0.08f);
    colors[ImGuiCol_ScrollbarBg]      = ImVec4(0, 0, 0, 0);
    colors[ImGuiCol_ScrollbarGrab]    = over;
}

// Returns whole pixels: sums that are not would need a bar to scroll.
ImVec2 rounded(float x, float y) { return ImVec2(std::floor(x), std::floor(y)); }

void set_style(float size)
{
    ImGuiStyle &style      = ImGui::GetStyle();
    style.WindowRounding   = 6;
    style.FrameRounding    = 4;
    style.GrabRounding     = 4;
    style.PopupRounding    = 5;
    style.WindowBorderSize = 1;
    style.GrabMinSize      = 9;
    style.ScrollbarSize    = 10;
    style.WindowPadding    = rounded(0.8f * size, 0.65f * size);
    style.FramePadding     = rounded(0.5f * size, 0.22f * size);
    style.ItemSpacing      = rounded(0.5f * size, 0.38f * size);
    set_colors(style.Colors);
}

ImFont *add_font(const char *path, float size)
{
    ImFontAtlas *atlas = ImGui::GetIO().Fonts;
    ImFont      *font  = path ? atlas->AddFontFromFileTTF(path, size) : nullptr;
    return font ? font : atlas->AddFontDefault();
}

// Sets where the next panel stands: the point, and which point of the panel is there.
void place(GuiCorner corner, float below)
{
    const ImVec2 size  = ImGui::GetIO().DisplaySize;
    const bool   right = corner == GUI_TOP_RIGHT || corner == GUI_BOTTOM_RIGHT;
    const bool   low   = corner == GUI_BOTTOM_LEFT || corner == GUI_BOTTOM_RIGHT;
    const ImVec2 at(right ? size.x - margin : margin,
                    low ? size.y - margin - below : margin + below);
    if (corner == GUI_CENTER)
        ImGui::SetNextWindowPos(ImVec2(size.x / 2, size.y / 2), ImGuiCond_Always,
                                ImVec2(0.5f, 0.5f));
    else
        ImGui::SetNextWindowPos(at, ImGuiCond_Always, ImVec2(right ? 1 : 0, low ? 1 : 0));
}

// Draws a text, or what of it fits into a width and three dots: then its tip has it all.
void text_within(const char *text, const char *end, float width)
{
    const char *cut = end;
    if (ImGui::CalcTextSize(text, end).x <= width) {
        ImGui::TextUnformatted(text, end);
        return;
    }
    width -= ImGui::CalcTextSize("...").x;
    while (cut > text && ((*cut & 0xC0) == 0x80 || ImGui::CalcTextSize(text, cut).x > width))
        cut--;
    ImGui::Text("%.*s...", static_cast<int>(cut - text), text);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%.*s", static_cast<int>(end - text), text);
}

// The label stands to the left; what is behind it takes the rest of the line.
void label_left(const char *label)
{
    const float behind = labels * ImGui::GetWindowWidth();
    const char *end    = label;
    while (*end && !(end[0] == '#' && end[1] == '#'))
        end++;
    ImGui::AlignTextToFramePadding();
    text_within(label, end, behind - ImGui::GetCursorPosX() - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SameLine(behind);
    ImGui::SetNextItemWidth(-1);
    ImGui::PushID(label);
}

} // namespace

extern "C" {

void gui_start(GLFWwindow *window, const char *sans, const char *mono, float size)
{
    ImGui::CreateContext();
    ImGuiIO &io    = ImGui::GetIO();
    io.IniFilename = nullptr;
    plain          = add_font(sans, size);
    source         = add_font(mono, 1.07f * size);
    set_style(size);
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init(nullptr);
}

void gui_stop(void)
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void gui_begin(void)
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void gui_end(void)
{
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool gui_has_mouse(void) { return ImGui::GetIO().WantCaptureMouse; }
bool gui_has_keys(void) { return ImGui::GetIO().WantTextInput; }

void gui_navigate(const char *panel)
{
    ImGuiIO &io = ImGui::GetIO();
    navigated   = panel;
    if (panel) {
        io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
        return;
    }
    io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::SetWindowFocus(nullptr);
}

bool gui_navigates(void)
{
    return (ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0;
}

bool gui_is_inside(void)
{
    const int any = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
    return ImGui::IsAnyItemActive() || ImGui::IsPopupOpen(nullptr, any);
}

void gui_backdrop(unsigned texture, float part)
{
    const ImVec2      size = ImGui::GetIO().DisplaySize;
    const ImTextureID id   = (ImTextureID) static_cast<size_t>(texture);
    ImGui::GetBackgroundDrawList()->AddImage(id, ImVec2(0, 0), ImVec2(part * size.x, size.y));
}

void gui_panel(const char *name, GuiPlace where, bool quiet)
{
    const float high  = gui_window_height() - where.below - where.spare;
    const float wide  = where.width > 0 ? where.width : where.most > 0 ? where.most : 1e9f;
    int         flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                ImGuiWindowFlags_AlwaysAutoResize;
    if (quiet)
        flags |= ImGuiWindowFlags_NoInputs; // of keys as well
    else
        flags &= ~ImGuiWindowFlags_NoScrollbar;
    place(where.corner, where.below);
    ImGui::SetNextWindowSizeConstraints(ImVec2(where.width, 0), ImVec2(wide, high));
    if (quiet)
        ImGui::SetNextWindowBgAlpha(0.72f);
    else if (where.corner == GUI_CENTER) // it is read, and much of it
        ImGui::SetNextWindowBgAlpha(0.97f);
    if (navigated && std::strcmp(navigated, name) == 0) {
        ImGui::SetNextWindowFocus();
        navigated = nullptr;
    }
    ImGui::Begin(name, nullptr, flags);
    const float padding = ImGui::GetStyle().WindowPadding.x;
    ImGui::PushTextWrapPos(where.most > 0 ? where.most - padding : -1); // -1: lines are not broken
}

float gui_panel_space(float width) { return width + 2 * margin; }

float gui_panel_end(void)
{
    const float height = ImGui::GetWindowHeight();
    ImGui::PopTextWrapPos();
    ImGui::End();
    return height + margin;
}

float gui_window_width(void) { return ImGui::GetIO().DisplaySize.x - 2 * margin; }
float gui_window_height(void) { return ImGui::GetIO().DisplaySize.y - 2 * margin; }

void gui_text(GuiTone tone, const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, tone_color(tone));
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
}

void gui_source(GuiTone tone, const char *text)
{
    ImGui::PushFont(source);
    gui_text(tone, text);
    ImGui::PopFont();
}

void gui_tip(const char *text)
{
    if (!ImGui::IsItemHovered())
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(26 * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void gui_heading(const char *text) { gui_text(GUI_FAINT, text); }
bool gui_section(const char *label)
{
    ImGui::PushStyleColor(ImGuiCol_Text, tone_color(GUI_FAINT));
    const bool open = ImGui::TreeNodeEx(label, ImGuiTreeNodeFlags_NoTreePushOnOpen);
    ImGui::PopStyleColor();
    return open;
}

void gui_gap(void) { ImGui::Dummy(ImVec2(0, 0.2f * ImGui::GetFontSize())); }
void gui_beside(void) { ImGui::SameLine(); }

bool gui_button(const char *label, bool on)
{
    if (on)
        ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.30f, 0.47f, 0.63f, 1));
    const bool pressed = ImGui::Button(label);
    if (on)
        ImGui::PopStyleColor();
    return pressed;
}

bool gui_line(const char *id, const char *text, GuiTone tone)
{
    ImGui::PushFont(source);
    const ImVec2 size = ImGui::CalcTextSize(text), at = ImGui::GetCursorPos();
    ImGui::PushID(id);
    const bool pressed = ImGui::Selectable("##line", false, 0, size);
    ImGui::PopID();
    ImGui::SetCursorPos(at);
    gui_text(tone, text);
    ImGui::PopFont();
    return pressed;
}

void gui_swatch(const unsigned char color[3])
{
    const float  side = ImGui::GetFontSize();
    const ImVec2 at   = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + side, at.y + side),
                                              IM_COL32(color[0], color[1], color[2], 255));
    ImGui::Dummy(ImVec2(side, side));
}

bool gui_slider(const char *label, double *value, double low, double high, const char *format)
{
    label_left(label);
    const bool changed = ImGui::SliderScalar("##value", ImGuiDataType_Double, value, &low, &high,
                                             format, ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopID();
    return changed;
}

bool gui_drag(const char *label, double *values, size_t count, double speed, double low,
              double high, const char *format)
{
    label_left(label);
    const bool changed = ImGui::DragScalarN("##values", ImGuiDataType_Double, values,
                                            static_cast<int>(count), static_cast<float>(speed),
                                            &low, &high, format, ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopID();
    return changed;
}

bool gui_check(const char *label, bool *on)
{
    label_left(label);
    const bool changed = ImGui::Checkbox("##check", on);
    ImGui::PopID();
    return changed;
}

bool gui_color(const char *label, double rgb[3])
{
    float color[3] = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                      static_cast<float>(rgb[2])};
    label_left(label);
    const bool changed = ImGui::ColorEdit3(
        "##color", color, ImGuiColorEditFlags_DisplayHex | ImGuiColorEditFlags_PickerHueWheel);
    ImGui::PopID();
    for (int i = 0; changed && i < 3; i++)
        rgb[i] = color[i];
    return changed;
}

bool gui_choice(const char *label, int *chosen, const char *const *names, size_t count)
{
    label_left(label);
    const bool changed = ImGui::Combo("##choice", chosen, names, static_cast<int>(count));
    ImGui::PopID();
    return changed;
}

bool gui_input(const char *label, char *text, size_t size)
{
    label_left(label);
    const bool entered = ImGui::InputText("##text", text, size,
                                          ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::PopID();
    return entered;
}

void gui_progress(double done)
{
    const ImVec2 size(13 * ImGui::GetFontSize(), 0.3f * ImGui::GetFontSize());
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrab));
    ImGui::ProgressBar(static_cast<float>(done), size, "");
    ImGui::PopStyleColor();
}

void gui_keys(const char *keys, const char *does)
{
    ImGui::PushFont(source);
    gui_text(GUI_STRONG, keys);
    ImGui::PopFont();
    ImGui::SameLine(8.5f * ImGui::GetFontSize());
    gui_text(GUI_PLAIN, does);
}

void gui_columns(int count)
{
    const float  gap = 1.2f * ImGui::GetFontSize(), needed = 58 * ImGui::GetFontSize();
    const ImVec2 old = ImGui::GetStyle().CellPadding;
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, ImVec2(gap / 2, old.y));
    ImGui::BeginTable("columns", ImGui::GetIO().DisplaySize.x < needed ? 1 : count,
                      ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoPadOuterX);
    ImGui::TableNextColumn();
}

void gui_next_column(void) { ImGui::TableNextColumn(); }
void gui_columns_end(void)
{
    ImGui::EndTable();
    ImGui::PopStyleVar();
}

void gui_scroll(int lines)
{
    const float step = static_cast<float>(lines) * ImGui::GetTextLineHeightWithSpacing();
    ImGui::SetScrollY(ImGui::GetScrollY() + step);
}

} // extern "C"
