// Memory for items that are constructed one by one, by whichever thread makes them.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace lucerna {

/// A fixed number of items without a value: each is to be constructed before it is read. A vector
/// would have one thread write all of them first, while the others wait.
template <typename T>
class RawArray {
    static_assert(std::is_trivially_destructible_v<T>);

public:
    RawArray() = default;
    explicit RawArray(std::size_t size)
        : items_(std::allocator<T>().allocate(size), Free{size}), size_(size) {}
    RawArray(RawArray&& other) noexcept
        : items_(std::move(other.items_)), size_(std::exchange(other.size_, 0)) {}
    RawArray& operator=(RawArray&& other) noexcept {
        items_ = std::move(other.items_);
        size_ = std::exchange(other.size_, 0);
        return *this;
    }

    void construct(std::size_t i, const T& value) { std::construct_at(items_.get() + i, value); }

    T& operator[](std::size_t i) { return items_.get()[i]; }
    const T& operator[](std::size_t i) const { return items_.get()[i]; }
    const T* data() const { return items_.get(); }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }

private:
    struct Free {
        std::size_t size = 0;
        void operator()(T* items) const { std::allocator<T>().deallocate(items, size); }
    };
    std::unique_ptr<T, Free> items_;
    std::size_t size_ = 0;
};

}  // namespace lucerna
