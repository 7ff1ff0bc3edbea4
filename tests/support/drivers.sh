# shellcheck shell=sh
# drivers.sh: Vulkan drivers that are installed but that the loader does not know; sourced.
#
# SwiftShader comes with Debian's chromium-common, and is nobody's default.

swiftshader_driver=/usr/lib/chromium/vk_swiftshader_icd.json

# Whether the words of `krs --device` are a part of SwiftShader's name.
asks_for_swiftshader() { # words
    case $(echo "$1" | tr '[:upper:]' '[:lower:]') in
    '') return 1 ;;
    *swiftshader* | *subzero*) return 0 ;;
    esac
    return 1
}

# Lets the loader find the driver of the device beside those that it knows.
add_driver_of() { # words of `krs --device`
    asks_for_swiftshader "$1" || return 0
    if [ ! -e "$swiftshader_driver" ]; then
        echo "$1: there is no $swiftshader_driver; Debian's chromium-common has it" >&2
        return 1
    fi
    case :${VK_ADD_DRIVER_FILES:-}: in
    *:"$swiftshader_driver":*) ;;
    *)
        VK_ADD_DRIVER_FILES=$swiftshader_driver${VK_ADD_DRIVER_FILES:+:$VK_ADD_DRIVER_FILES}
        export VK_ADD_DRIVER_FILES
        ;;
    esac
}
