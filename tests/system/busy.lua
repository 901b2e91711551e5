-- busy.lua N: a service that is busy N times, then says of every pair that it is separated. Prints
-- the sequence number of each query, and whether it was busy.
unpack = unpack or table.unpack -- what lcm-gen writes is for Lua 5.1

local lcm = require 'lcm'
local pair_query_t = require 'fmb_msgs.pair_query_t'
local pair_result_t = require 'fmb_msgs.pair_result_t'

local refusals = tonumber(arg[1])
local bus = lcm.lcm.new(os.getenv('LCM_DEFAULT_URL') or 'udpm://239.255.76.67:7667?ttl=0')

bus:subscribe('FMB_PAIR_QUERY', function(_, bytes)
    local query = pair_query_t.decode(bytes)
    local result = pair_result_t:new()
    result.client_id = query.client_id
    result.sequence_number = query.sequence_number
    if refusals > 0 then
        refusals = refusals - 1
        result.status = pair_result_t.STATUS_BUSY
    else
        result.verdict = pair_result_t.VERDICT_SEPARATED
    end
    print(query.sequence_number .. (result.status == 0 and '' or ' busy'))
    io.stdout:flush()
    bus:publish('FMB_PAIR_RESULT', result:encode())
end)

while true do
    bus:handle()
end
