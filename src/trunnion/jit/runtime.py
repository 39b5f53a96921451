"""What Numba's machine code calls of Numba's runtime, written anew for libraries that run without it."""

from typing import Final

#: What kernels with arrays and lists of their own call of Numba's runtime. A ``MemInfo`` has 48 bytes: count of
#: references, destructor, its argument, address of the data, their size, allocator. With a destructor, the data have
#: memory of their own, and its argument is what takes their elements apart.
#: The last ones would put a text about shapes into an exception: it is raised without.
RUNTIME: Final = """
define ptr @NRT_Allocate(i64 %size) {
  %made = call ptr @malloc(i64 %size)
  ret ptr %made
}
define void @NRT_Free(ptr %made) {
  call void @free(ptr %made)
  ret void
}
define void @fill(ptr %made, ptr %dtor, ptr %info, ptr %data, i64 %size) {
  store i64 1, ptr %made
  %p1 = getelementptr i8, ptr %made, i64 8
  store ptr %dtor, ptr %p1
  %p2 = getelementptr i8, ptr %made, i64 16
  store ptr %info, ptr %p2
  %p3 = getelementptr i8, ptr %made, i64 24
  store ptr %data, ptr %p3
  %p4 = getelementptr i8, ptr %made, i64 32
  store i64 %size, ptr %p4
  %p5 = getelementptr i8, ptr %made, i64 40
  store ptr null, ptr %p5
  ret void
}
define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) {
  %a = zext i32 %align to i64
  %head = add i64 %a, 48
  %total = add i64 %head, %size
  %made = call ptr @malloc(i64 %total)
  %none = icmp eq ptr %made, null
  br i1 %none, label %end, label %fill
fill:
  %from = ptrtoint ptr %made to i64
  %least = add i64 %from, %head
  %over = urem i64 %least, %a
  %offset = sub i64 %head, %over
  %data = getelementptr i8, ptr %made, i64 %offset
  call void @fill(ptr %made, ptr null, ptr null, ptr %data, i64 %size)
  br label %end
end:
  ret ptr %made
}
define ptr @NRT_MemInfo_alloc(i64 %size) {
  %made = call ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 16)
  ret ptr %made
}
define ptr @NRT_MemInfo_new_varsize_dtor(i64 %size, ptr %info) {
  %made = call ptr @malloc(i64 48)
  %data = call ptr @malloc(i64 %size)
  %none1 = icmp eq ptr %made, null
  %none2 = icmp eq ptr %data, null
  %none = or i1 %none1, %none2
  br i1 %none, label %fail, label %fill
fill:
  call void @fill(ptr %made, ptr %made, ptr %info, ptr %data, i64 %size)
  ret ptr %made
fail:
  call void @free(ptr %made)
  call void @free(ptr %data)
  ret ptr null
}
define ptr @NRT_MemInfo_varsize_realloc(ptr %made, i64 %size) {
  %p3 = getelementptr i8, ptr %made, i64 24
  %p4 = getelementptr i8, ptr %made, i64 32
  %old = load ptr, ptr %p3
  %new = call ptr @realloc(ptr %old, i64 %size)
  store ptr %new, ptr %p3
  store i64 %size, ptr %p4
  ret ptr %new
}
define void @NRT_MemInfo_call_dtor(ptr %made) {
  %p1 = getelementptr i8, ptr %made, i64 8
  %dtor = load ptr, ptr %p1
  %plain = icmp eq ptr %dtor, null
  br i1 %plain, label %end, label %own
own:
  %p2 = getelementptr i8, ptr %made, i64 16
  %info = load ptr, ptr %p2
  %p3 = getelementptr i8, ptr %made, i64 24
  %data = load ptr, ptr %p3
  %flat = icmp eq ptr %info, null
  br i1 %flat, label %freed, label %apart
apart:
  call void %info(ptr %data)
  br label %freed
freed:
  call void @free(ptr %data)
  br label %end
end:
  call void @free(ptr %made)
  ret void
}
@PyExc_RuntimeError = global i8 0
define ptr @PyUnicode_FromKindAndData(i32 %a, ptr %b, i64 %c) {
  ret ptr null
}
define i64 @PyObject_Hash(ptr %a) {
  ret i64 0
}
define ptr @PyTuple_Pack(i64 %a, ...) {
  ret ptr null
}
define void @PyErr_SetString(ptr %a, ptr %b) {
  ret void
}
define i8 @last_taken(ptr %count, i64 %by) {
  %before = atomicrmw sub ptr %count, i64 %by seq_cst
  %none = icmp eq i64 %before, %by
  %is_last = zext i1 %none to i8
  ret i8 %is_last
}
declare ptr @malloc(i64)
declare ptr @realloc(ptr, i64)
declare void @free(ptr)
"""
