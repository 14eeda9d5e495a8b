#version 460

layout(location = 0) flat in uint in_source;
layout(location = 0) out uint out_source;

void main()
{
    out_source = in_source;
}
