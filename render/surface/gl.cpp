#include "surface/gl.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace achilles {

namespace {

// The first lines of a shader.
#if defined(__EMSCRIPTEN__)
constexpr const char* shader_version = "#version 300 es\nprecision highp float;\n";
#else
constexpr const char* shader_version = "#version 330 core\n";
#endif

}  // namespace

Gl::Gl(const AddressFunction& address_of) {
// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot stand in them
#define ACHILLES_GL_LOAD(type, name)                       \
    name = reinterpret_cast<type>(address_of("gl" #name)); \
    if (name == nullptr) throw std::runtime_error("OpenGL 3.3 lacks gl" #name " on this machine");
    ACHILLES_GL_FUNCTIONS(ACHILLES_GL_LOAD)
#undef ACHILLES_GL_LOAD
    // NOLINTEND(bugprone-macro-parentheses)
}

GLuint Gl::program(const char* vertex, const char* fragment) const {
    const GLuint linked = CreateProgram();
    for (const auto& [kind, text] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = CreateShader(static_cast<GLenum>(kind));
        const char* const texts[] = {shader_version, text};
        ShaderSource(shader, 2, texts, nullptr);
        CompileShader(shader);
        AttachShader(linked, shader);
        DeleteShader(shader);  // lives on inside the program
    }
    LinkProgram(linked);
    GLint ok = 0;
    GetProgramiv(linked, GL_LINK_STATUS, &ok);
    if (ok == 0) {
        std::array<char, 1024> log{};
        GetProgramInfoLog(linked, static_cast<GLsizei>(log.size() - 1), nullptr, log.data());
        throw std::runtime_error(std::string("OpenGL refuses a shader: ") + log.data());
    }
    return linked;
}

GLuint Gl::texture(GLint format, int width, int height, GLenum layout, const void* pixels) const {
    GLuint made = 0;
    GenTextures(1, &made);
    BindTexture(GL_TEXTURE_2D, made);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, GL_UNSIGNED_BYTE, pixels);
    return made;
}

GLuint Gl::framebuffer(GLuint target) const {
    GLuint made = 0;
    GenFramebuffers(1, &made);
    BindFramebuffer(GL_FRAMEBUFFER, made);
    FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    if (CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("OpenGL cannot create an image of this size: use a smaller window or picture");
    return made;
}

}  // namespace achilles
